// SPDX-License-Identifier: Apache-2.0
// kinfer convert: between model formats, and INS recordings and joint trajectories to MCAP, by file extension.
#include <filesystem>
#include <memory>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/motion/trajectory_mcap.hpp"
#include "kinfer/io/pose_set/pose_log.hpp"
#include "kinfer/io/recording/ins_mcap.hpp"
#include "kinfer/io/recording/possible_times.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {
namespace {

struct ConvertArguments {
  RobotOption in;
  std::string out, robot;
  bool quiet = false;
};

/// An INS recording as .mcap.
int convert_recording(const ConvertArguments& options) {
  const std::filesystem::path path = options.in.path;
  const auto recording = read_recording(std::span(&path, 1));
  if (!recording) return fail(recording.error());
  if (const auto seconds = expect_seconds(*recording); !seconds) return fail(seconds.error());
  if (const auto done = write_ins_mcap(options.out, *recording); !done) return fail(done.error());
  if (!options.quiet) print_text("{}: {} sensors\n", options.out, recording->sensors.size());
  return exit_done;
}

/// Joint positions over time as .mcap, with the chain that they move.
int convert_trajectory(const ConvertArguments& options) {
  const auto chain = read_robot({options.robot, options.in.base_link, options.in.tip_link});
  if (!chain) return fail(chain.error());
  const auto joints = read_pose_log(options.in.path, chain->chain, {}, RequiredContent::joints_only);
  if (!joints) return fail(joints.error());
  const auto done = write_trajectory_mcap(options.out, chain->chain, joints->set);
  if (!done) return fail({fmt::format("{}: {}", options.in.path, done.error().what)});
  if (!options.quiet)
    print_text("{}: {} rows of {} joints\n", options.out, joints->set.rows(), joints->set.joints.rows());
  return exit_done;
}

int run(const ConvertArguments& options) {
  if (auto other = expect_other_file(options.out, {options.in.path, options.robot}); !other) return fail(other.error());
  const bool is_mcap = std::filesystem::path(options.out).extension() == ".mcap";
  if (!options.robot.empty() && !is_mcap)
    return fail({"--robot: no effect but on a joint trajectory that is written as .mcap"});
  if (is_mcap) return options.robot.empty() ? convert_recording(options) : convert_trajectory(options);
  const auto robot = read_robot(options.in);
  if (!robot) return fail(robot.error());
  if (const auto done = write_robot_model(options.out, *robot); !done) return fail(done.error());
  if (!options.quiet) print_text("{}: {} joints\n", options.out, robot->chain.joints.size());
  return exit_done;
}

}  // namespace

Verb add_convert(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "convert",
      "Turn a robot model into another format, or an INS recording or a joint trajectory into .mcap, by file extension",
      "Example:\n  kinfer convert calibration/chain.toml robot.urdf\n  kinfer convert drive/imu.csv drive.mcap\n"
      "  kinfer convert path.csv path.mcap --robot calibration/chain.toml");
  auto options = std::make_shared<ConvertArguments>();
  add_robot_option(*verb, options->in, "in",
                   "Model to read: " + readable_model_formats() +
                       "; an INS recording; or joint positions with a column t, with --robot");
  add_text(*verb, "out", options->out,
           "Model to write: " + writable_model_extensions() + " (.xml: MJCF); .mcap for a recording",
           Requirement::required, "FILE");
  add_text(*verb, "--robot", options->robot, "Chain that a joint trajectory moves, to write it as .mcap",
           Requirement::optional, "FILE");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
