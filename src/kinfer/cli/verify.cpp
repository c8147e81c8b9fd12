// kinfer verify: is an earlier calibration still good on new measurements?
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/calibrate/verify.hpp"
#include "kinfer/cli/robot_option.hpp"
#include "kinfer/cli/summary.hpp"
#include "kinfer/cli/verbs.hpp"
#include "kinfer/io/pose_set_csv.hpp"

namespace kinfer::cli {
namespace {

struct Options {
  CommonOptions common;
  RobotOption chain;
  std::string data, columns;
};

void print(const Verification& v, const CommonOptions& common) {
  if (common.json) {
    const auto figures = [](const ErrorStatistics& s) {
      return nlohmann::ordered_json{{"mean", s.mean}, {"rms", s.rms}, {"sd", s.sd}, {"max", s.max}, {"n", s.n}};
    };
    const nlohmann::ordered_json json{{"verdict", v.verdict},
                                      {"good", v.good},
                                      {"as_it_stands", figures(v.as_it_stands)},
                                      {"frames_refitted", figures(v.frames_refitted)}};
    fmt::print("{}\n", json.dump());
  } else if (!common.quiet) {
    fmt::print("{}\n\n  as it stands            {}\n  base and tool refitted  {}\n", v.verdict,
               statistics_line(v.as_it_stands), statistics_line(v.frames_refitted));
  }
}

int run(const Options& options) {
  const auto robot = read_robot(options.chain);
  if (!robot) return fail(robot.error());
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  const auto data = read_pose_set(options.data, robot->chain, *map);
  if (!data) return fail(data.error());
  const auto verification = verify(robot->chain, robot->tolerances, robot->instrument, *data);
  if (!verification) return fail(verification.error());
  print(*verification, options.common);
  return verification->good ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_verify(CLI::App& app) {
  CLI::App* verb = add_command(app, "verify", "Is an earlier calibration still good on new measurements?",
                               "Exit code 1: not good any more.\nExample:\n"
                               "  kinfer verify --chain calibration/chain.toml --data today.csv");
  auto options = std::make_shared<Options>();
  add_robot_option(*verb, options->chain, "--chain", "chain.toml of the calibration");
  add_text(*verb, "--data", options->data, "New pose set", Need::required, "CSV");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Need::optional,
           "TOML");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
