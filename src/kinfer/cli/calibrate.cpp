// kinfer calibrate: nominal robot + outside measurements -> corrected robot + evidence.
#include "kinfer/calibrate/calibrate.hpp"

#include <charconv>
#include <memory>

#include "kinfer/base/sha256.hpp"
#include "kinfer/cli/robot_option.hpp"
#include "kinfer/cli/search_options.hpp"
#include "kinfer/cli/summary.hpp"
#include "kinfer/cli/verbs.hpp"
#include "kinfer/io/evidence_json.hpp"
#include "kinfer/io/parameter_names_toml.hpp"
#include "kinfer/io/pose_set_csv.hpp"
#include "kinfer/io/text_file.hpp"
#include "kinfer/io/urdf.hpp"
#include "kinfer/measurement/join.hpp"

namespace kinfer::cli {
namespace {

struct Options {
  CommonOptions common;
  SearchArguments search;
  RobotOption robot;
  std::string data, out, columns, holdout, parameters = "auto";
};

/// What the files said.
struct Inputs {
  RobotModel robot;
  PoseSet data;
  CalibrateOptions how;
};

Result<ParameterChoice> read_parameter_choice(const std::string& text) {
  if (text == "auto") return AutoParameters{};
  if (text == "paper24") return Paper24Parameters{};
  KINFER_TRY(names, read_parameter_names(text));
  return NamedParameters{names};
}

/// A number is a fraction; anything else is a pose set whose rows are held out.
Result<HoldoutChoice> add_holdout(const std::string& text, const RobotModel& robot, const ColumnMap& map,
                                  PoseSet& data) {
  if (text.empty()) return CrossValidation{};
  double fraction = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), fraction);
  if (code == std::errc{} && end == text.data() + text.size()) {
    if (fraction <= 0.0 || fraction >= 1.0)
      return error("--holdout {}: expected a fraction between 0 and 1, or a file", text);
    return HeldOutFraction{fraction};
  }
  KINFER_TRY(kept_aside, read_pose_set(text, robot.chain, map));
  data = joined(data, kept_aside);
  return HeldOutByLabel{};
}

Result<Inputs> read_inputs(const Options& options) {
  Inputs inputs;
  KINFER_TRY(robot, read_robot(options.robot));
  KINFER_TRY(map, read_columns_option(options.columns));
  KINFER_TRY(data, read_pose_set(options.data, robot.chain, map));
  KINFER_TRY(parameters, read_parameter_choice(options.parameters));
  KINFER_TRY(holdout, add_holdout(options.holdout, robot, map, data));
  inputs.how = {.parameters = parameters, .holdout = holdout, .threads = options.common.threads};
  KINFER_TRY(population, population_options(options.search, options.common.threads));
  inputs.how.population = population;
  inputs.robot = std::move(robot);
  inputs.data = std::move(data);
  return inputs;
}

std::vector<std::string> input_paths(const Options& options) {
  std::vector<std::string> paths{options.robot.path, options.data};
  for (const std::string& path : {options.columns, options.parameters, options.holdout})
    if (std::filesystem::is_regular_file(path)) paths.push_back(path);
  for (const std::string& path : input_paths(options.search)) paths.push_back(path);
  return paths;
}

Provenance provenance_of(const Options& options) {
  Provenance provenance;
  provenance.seed = options.common.seed;
  for (const std::string& path : input_paths(options))
    if (const auto text = read_text_file(path))
      provenance.inputs.push_back({std::filesystem::path(path).filename().string(), sha256(*text)});
  const auto plain = [](const std::string& value) { return std::filesystem::path(value).filename().string(); };
  provenance.options.emplace_back("--parameters", plain(options.parameters));
  if (options.search.method != "lm") provenance.options.emplace_back("--method", options.search.method);
  if (!options.holdout.empty()) provenance.options.emplace_back("--holdout", plain(options.holdout));
  return provenance;
}

Result<void> write_results(const Options& options, RobotModel robot, const Calibration& calibration) {
  const std::filesystem::path folder(options.out);
  StandardDeviations sd;
  for (const ParameterEstimate& p : calibration.estimate.values) sd[p.name] = p.sd;
  robot.chain = with_turns_folded(calibration.estimate.chain);
  if (auto done = write_text_file(folder / "chain.toml", robot_toml(robot, sd)); !done) return done;
  if (auto done = write_text_file(folder / "chain.urdf", urdf(robot.chain)); !done) return done;
  if (const std::string& net = calibration.estimate.search.net; !net.empty())
    if (auto done = write_text_file(folder / "net.txt", net); !done) return done;
  return write_text_file(folder / "evidence.json", calibration_json(calibration, provenance_of(options)));
}

int run(const Options& options) {
  RunRecord record("calibrate", options.common);
  for (const std::string& path : input_paths(options)) record.add_input(path);
  auto inputs = read_inputs(options);
  if (!inputs) return fail(inputs.error());
  const auto folder = OutputFolder::make(options.out);
  if (!folder) return fail(folder.error());
  CalibrateTask task{inputs->robot.chain, inputs->robot.tolerances, inputs->robot.instrument, inputs->data, {}, {}};
  if (auto done = read_earlier_calibrations(options.search, task); !done) return fail(done.error());
  Result<Calibration> calibration = [&] {
    ProgressLine progress(options.common);
    return calibrate(task, inputs->how, Rng(options.common.seed), progress.observer());
  }();
  if (!calibration) return fail(calibration.error());
  if (auto done = write_results(options, inputs->robot, *calibration); !done) return fail(done.error());
  if (auto done = record.write(options.out); !done) return fail(done.error());
  if (options.common.json)
    fmt::print("{}", calibration_headline_json(*calibration));
  else if (!options.common.quiet)
    fmt::print("{}", calibration_summary(*calibration));
  return calibration->use ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_calibrate(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "calibrate", "Correct a robot's model from outside measurements, and prove the gain",
                  "No initial guess of base and tool is needed.\nExample:\n"
                  "  kinfer calibrate --robot robot.toml --data poses.csv --out calibration\n"
                  "  kinfer predict --chain calibration/chain.toml --joints joints.csv -o predicted.csv");
  auto options = std::make_shared<Options>();
  add_robot_option(*verb, options->robot, "--robot", "Nominal model: TOML or URDF");
  add_text(*verb, "--data", options->data, "Pose set: joint readings and measurements", Need::required, "CSV");
  add_text(*verb, "--out", options->out, "Folder for chain.toml, chain.urdf, evidence.json, run.json", Need::required,
           "DIR");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Need::optional,
           "TOML");
  add_text(*verb, "--parameters", options->parameters,
           "auto: the complete geometric set; paper24: a alpha d theta of each joint (base and tool as given, or from "
           "the data where those disagree); or a TOML file "
           "with parameters = [\"a2\", ...]");
  add_text(*verb, "--holdout", options->holdout,
           "Rows that are never fitted: a fraction (0.2), or a further pose set (default: 5-fold cross-validation)");
  add_search_arguments(*verb, options->search);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
