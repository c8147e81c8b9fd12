// SPDX-License-Identifier: Apache-2.0
// kinfer convert: between model formats, by file extension.
#include <memory>

#include "kinfer/cli/parts/robot_option.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/robot/mjcf.hpp"
#include "kinfer/io/robot/urdf.hpp"
#include "kinfer/io/text/text_file.hpp"

namespace kinfer::cli {
namespace {

struct ConvertArguments {
  RobotOption in;
  std::string out;
  bool quiet = false;
};

int run(const ConvertArguments& options) {
  const auto robot = read_robot(options.in);
  if (!robot) return fail(robot.error());
  const std::string ending = std::filesystem::path(options.out).extension().string();
  std::string text;
  if (ending == ".urdf")
    text = format_urdf(robot->chain);
  else if (ending == ".mjcf" || ending == ".xml")
    text = format_mjcf(robot->chain);
  else if (ending == ".toml")
    text = format_robot_toml(*robot);
  else
    return fail({fmt::format("{}: expected an ending .toml, .urdf or .mjcf", options.out)});
  if (const auto done = write_text_file(options.out, text); !done) return fail(done.error());
  if (!options.quiet) fmt::print("{}: {} joints\n", options.out, robot->chain.joints.size());
  return exit_done;
}

}  // namespace

Verb add_convert(CLI::App& app) {
  CLI::App* verb = add_command(app, "convert", "Turn a robot model into another format: TOML, URDF, MJCF",
                               "Example:\n  kinfer convert calibration/chain.toml robot.urdf");
  auto options = std::make_shared<ConvertArguments>();
  add_robot_option(*verb, options->in, "in", "Model to read: .toml or .urdf");
  add_text(*verb, "out", options->out, "Model to write: .toml, .urdf or .mjcf (.xml)", Requirement::required, "FILE");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
