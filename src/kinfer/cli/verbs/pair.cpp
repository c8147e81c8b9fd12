// SPDX-License-Identifier: Apache-2.0
// kinfer pair: a robot's joint log and a tracker's file -> a pose set.
#include <memory>

#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/text/text_file.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/pairing/paired_set.hpp"

namespace kinfer::cli {
namespace {

struct PairArguments {
  RobotOption robot;
  std::string joints, measured, joint_columns, measured_columns, by = "auto", out;
  double offset = 0.0;
  bool has_offset = false, quiet = false;
};

std::optional<PairingMethod> method_named(const std::string& text) {
  for (const PairingMethod method : {PairingMethod::name, PairingMethod::time, PairingMethod::order})
    if (name(method) == text) return method;
  return std::nullopt;
}

std::string place_of(const PoseSet& set, const Rest& rest) {
  const auto line = [&](int row) { return set.line[static_cast<std::size_t>(row)]; };
  std::string text = rest.name.empty() ? "" : fmt::format("{}, ", rest.name);
  text += rest.rows == 1 ? fmt::format("line {}", line(rest.first_row))
                         : fmt::format("lines {} to {}", line(rest.first_row), line(rest.first_row + rest.rows - 1));
  if (rest.end > 0.0) text += fmt::format(", {:.2f} s to {:.2f} s", rest.begin, rest.end);
  return text;
}

void print_alone(const std::string& file, const PoseSet& set, const std::vector<Rest>& rests,
                 const std::vector<int>& alone) {
  for (const int i : alone)
    fmt::print("  no partner: {} ({})\n", file, place_of(set, rests[static_cast<std::size_t>(i)]));
}

void print_pairing(const PairArguments& options, const PoseSet& joints, const PoseSet& measured, const RestLists& lists,
                   const RestPairing& pairing) {
  fmt::print("{} pairs by {} of {} rests of the robot and {} of the tracker\n", pairing.pairs.size(),
             name(pairing.method), lists.joints.size(), lists.measured.size());
  if (pairing.method == PairingMethod::time)
    fmt::print("the tracker's clock is {:+.3f} s off and drifts by {:.1f} ppm; begins and ends agree to {:.3f} s\n",
               pairing.offset, 1e6 * pairing.drift, pairing.timing_error);
  fmt::print("distances between successive points differ from the nominal model's by {:.2f} mm (median)\n",
             1e3 * pairing.distance_error);
  print_alone(options.joints, joints, lists.joints, pairing.joints_alone);
  print_alone(options.measured, measured, lists.measured, pairing.measured_alone);
}

Result<PoseSet> read_side(const std::string& file, const std::string& columns, const Chain& chain,
                          RequiredContent required) {
  KINFER_TRY(map, read_columns_option(columns));
  return read_pose_set(file, chain, map, required);
}

int run(const PairArguments& options) {
  const auto robot = read_robot(options.robot);
  if (!robot) return fail(robot.error());
  const auto joints = read_side(options.joints, options.joint_columns, robot->chain, RequiredContent::joints_only);
  if (!joints) return fail(joints.error());
  const auto measured = read_side(options.measured, options.measured_columns, robot->chain, RequiredContent::targets);
  if (!measured) return fail(measured.error());
  RestLists lists{.joints = joint_rests(*joints), .measured = measured_rests(*measured)};
  for (const Rest& rest : lists.joints) lists.predicted.push_back(forward(robot->chain, rest.mean).position);
  const auto pairing =
      pair_rests(lists, method_named(options.by), options.has_offset ? std::optional(options.offset) : std::nullopt);
  if (!pairing) return fail({fmt::format("{}, {}: {}", options.joints, options.measured, pairing.error().what)});
  if (options.has_offset && pairing->method != PairingMethod::time)
    return fail({fmt::format("--offset: no effect on pairing by {}", name(pairing->method))});
  const PoseSet set = paired_set(*joints, *measured, lists, *pairing);
  const auto done = write_text_file(options.out, format_pose_set_csv(set, robot->chain, FileUnits::mm_deg));
  if (!done) return fail(done.error());
  if (!options.quiet) print_pairing(options, *joints, *measured, lists, *pairing);
  return exit_done;
}

}  // namespace

Verb add_pair(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "pair", "Match a robot's joint log with a tracker's file: the poses that calibrate wants",
                  "Streams are cut into rests, and these are matched by time, whatever the offset and drift of the "
                  "clocks; lists by "
                  "name\n(column id) or by order.\nExample:\n"
                  "  kinfer pair --robot robot.toml --joints joints.csv --measured tracker.csv --out poses.csv");
  auto options = std::make_shared<PairArguments>();
  add_robot_option(*verb, options->robot, "--robot", "Robot: " + readable_model_formats());
  add_text(*verb, "--joints", options->joints, "Joint positions: a stream with column t, or a list",
           Requirement::required, "CSV");
  add_text(*verb, "--measured", options->measured, "Measured tool points x, y, z: a stream with column t, or a list",
           Requirement::required, "CSV");
  add_text(*verb, "--columns", options->joint_columns, "How the joint file's columns map to kinfer's",
           Requirement::optional, "TOML");
  add_text(*verb, "--measured-columns", options->measured_columns, "How the tracker file's columns map to kinfer's",
           Requirement::optional, "TOML");
  add_choice(*verb, "--by", options->by, {"auto", "name", "time", "order"}, "What tells the partner of a rest");
  add_number(*verb, "--offset", options->offset, options->has_offset, -1e10, 1e10,
             "By time: tracker's clock minus robot's, roughly [s]");
  add_text(*verb, "--out", options->out, "Pose set to write", Requirement::required, "CSV");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
