// SPDX-License-Identifier: Apache-2.0
// kinfer convert: between model formats, and INS recordings to MCAP, by file extension.
#include <filesystem>
#include <memory>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/recording/ins_mcap.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {
namespace {

struct ConvertArguments {
  RobotOption in;
  std::string out;
  bool quiet = false;
};

/// An INS recording as .mcap.
int convert_recording(const ConvertArguments& options) {
  const std::filesystem::path path = options.in.path;
  const auto recording = read_recording(std::span(&path, 1));
  if (!recording) return fail(recording.error());
  if (const auto done = write_ins_mcap(options.out, *recording); !done) return fail(done.error());
  if (!options.quiet) fmt::print("{}: {} sensors\n", options.out, recording->sensors.size());
  return exit_done;
}

int run(const ConvertArguments& options) {
  if (std::filesystem::path(options.out).extension() == ".mcap") return convert_recording(options);
  const auto robot = read_robot(options.in);
  if (!robot) return fail(robot.error());
  if (const auto done = write_robot_model(options.out, *robot); !done) return fail(done.error());
  if (!options.quiet) fmt::print("{}: {} joints\n", options.out, robot->chain.joints.size());
  return exit_done;
}

}  // namespace

Verb add_convert(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "convert", "Turn a robot model into another format, or an INS recording into .mcap, by file extension",
      "Example:\n  kinfer convert calibration/chain.toml robot.urdf\n  kinfer convert drive/imu.csv drive.mcap");
  auto options = std::make_shared<ConvertArguments>();
  add_robot_option(*verb, options->in, "in", "Model to read: " + readable_model_formats() + "; or an INS recording");
  add_text(*verb, "out", options->out,
           "Model to write: " + writable_model_extensions() + " (.xml: MJCF); .mcap for a recording",
           Requirement::required, "FILE");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
