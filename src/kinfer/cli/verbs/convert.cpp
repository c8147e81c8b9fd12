// SPDX-License-Identifier: Apache-2.0
// kinfer convert: between model formats, by file extension.
#include <memory>

#include "kinfer/cli/parts/robot_option.hpp"
#include "kinfer/cli/verb_list.hpp"

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
  if (const auto done = write_robot_model(options.out, *robot); !done) return fail(done.error());
  if (!options.quiet) fmt::print("{}: {} joints\n", options.out, robot->chain.joints.size());
  return exit_done;
}

}  // namespace

Verb add_convert(CLI::App& app) {
  CLI::App* verb = add_command(app, "convert", "Turn a robot model into another format, by file extension",
                               "Example:\n  kinfer convert calibration/chain.toml robot.urdf");
  auto options = std::make_shared<ConvertArguments>();
  add_robot_option(*verb, options->in, "in", "Model to read: " + readable_model_formats());
  add_text(*verb, "out", options->out, "Model to write: " + writable_model_extensions() + " (.xml: MJCF)",
           Requirement::required, "FILE");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
