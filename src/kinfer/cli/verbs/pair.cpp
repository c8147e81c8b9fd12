// SPDX-License-Identifier: Apache-2.0
// kinfer pair: a robot's joint log and a tracker's file -> a pose set.
#include <memory>

#include "kinfer/cli/options/pairing_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

struct PairArguments {
  RobotOption robot;
  PairingOption pairing;
  std::string joint_columns, out;
  bool quiet = false;
};

int run(const PairArguments& options) {
  if (auto other = expect_other_file(options.out, {options.pairing.joints, options.pairing.measured, options.robot.path,
                                                   options.joint_columns, options.pairing.measured_columns});
      !other)
    return fail(other.error());
  const auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  constexpr bool has_model = true;
  const auto paired = read_paired(options.pairing, options.joint_columns, robot->chain, has_model);
  if (!paired) return fail(paired.error());
  const auto done = write_text_file(options.out, format_pose_set_csv(paired->set, robot->chain, FileUnits::mm_deg));
  if (!done) return fail(done.error());
  if (!options.quiet) print_text("{}", pairing_summary(options.pairing, *paired));
  return exit_done;
}

}  // namespace

Verb add_pair(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "pair", "Match a robot's joint log with a tracker's file: the poses that calibrate wants",
                  "Streams are cut into rests, and these are matched by time, whatever the offset and drift of the "
                  "clocks; lists by "
                  "name\n(column id) or by order. calibrate does the same with the same options.\nExample:\n"
                  "  kinfer pair --robot robot.toml --joints joints.csv --measured tracker.csv --out poses.csv");
  auto options = std::make_shared<PairArguments>();
  add_robot_option(*verb, options->robot, "--robot", "Robot: " + readable_model_formats());
  add_pairing_options(*verb, options->pairing, Requirement::required);
  add_text(*verb, "--columns", options->joint_columns, "How the joint file's columns map to kinfer's",
           Requirement::optional, "TOML");
  add_text(*verb, "--out", options->out, "Pose set to write", Requirement::required, "CSV");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
