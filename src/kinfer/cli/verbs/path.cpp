// SPDX-License-Identifier: Apache-2.0
// kinfer path: a timed path through postures or tool targets, within the limits of the joints.
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/joint_columns.hpp"
#include "kinfer/cli/options/posture_argument.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/parts/unreached_targets.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/motion/path_csv.hpp"
#include "kinfer/io/motion/reach_targets_csv.hpp"
#include "kinfer/motion/timed_paths.hpp"
#include "kinfer/words/motion/path.hpp"

namespace kinfer::cli {
namespace {

struct PathArguments {
  CommonOptions common;
  RobotOption chain;
  std::string from, to, targets, columns, out, prefer;
  std::vector<std::string> via;
  std::string velocity = "90", acceleration = "360", jerk = "3600";  // deg and mm
  double tool_speed = 250.0, corner = 3.0, step = 4.0;               // mm/s, deg or mm, ms
  bool stop = false;
};

/// One number for all joints or one for each, in deg and mm.
Result<VectorXd> joint_values(const std::string& option, const std::string& text, const Chain& chain) {
  const bool is_one = text.find(',') == std::string::npos;
  std::string list = text;
  for (int k = 1; is_one && k < dof(chain); ++k) list += "," + text;
  KINFER_TRY(values, parse_motion_limits(option, list, chain));
  for (const double value : values)
    if (!(value > 0.0)) return error("{}: expected limits above 0, found \"{}\"", option, text);
  return values;
}

Result<std::vector<motion::MotionLimits>> joint_limits(const PathArguments& options, const Chain& chain) {
  KINFER_TRY(velocity, joint_values("--velocity", options.velocity, chain));
  KINFER_TRY(acceleration, joint_values("--acceleration", options.acceleration, chain));
  KINFER_TRY(jerk, joint_values("--jerk", options.jerk, chain));
  std::vector<motion::MotionLimits> limits;
  for (Eigen::Index k = 0; k < velocity.size(); ++k) limits.push_back({velocity[k], acceleration[k], jerk[k]});
  return limits;
}

Result<MatrixXd> waypoints(const PathArguments& options, const Chain& chain) {
  std::vector<VectorXd> list;
  KINFER_TRY(from, parse_posture("--from", options.from, chain));
  list.push_back(from);
  for (const std::string& via : options.via) {
    KINFER_TRY(posture, parse_posture("--via", via, chain));
    list.push_back(posture);
  }
  KINFER_TRY(to, parse_posture("--to", options.to, chain));
  list.push_back(to);
  MatrixXd matrix(from.size(), static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = list[i];
  return matrix;
}

/// A path of too many rows is refused with the options that make them fewer.
Result<PathResult> with_remedy(Result<PathResult> path, const std::string& options) {
  if (!path) return error("{}; a larger {} makes them fewer", path.error().what, options);
  return path;
}

Result<PathResult> along_tool_lines(const PathArguments& options, const Chain& chain,
                                    const std::vector<motion::MotionLimits>& limits) {
  KINFER_TRY(map, read_columns_option(options.columns));
  KINFER_TRY(read, read_reach_targets(options.targets, chain, map));
  for (const ReachTarget& target : read.targets)
    if (target.orientation.index() != read.targets.front().orientation.index())
      return error("{}: the rows of a path must all direct the orientation in the same way", options.targets);
  VectorXd preferred = read.preferred.size() > 0 ? VectorXd(read.preferred.col(0)) : motion::middle_posture(chain);
  if (!options.prefer.empty()) {
    KINFER_TRY(posture, parse_posture("--prefer", options.prefer, chain));
    preferred = posture;
  }
  motion::ToolPathOptions how;
  const double scale = 1e-3 * options.tool_speed / how.translation.velocity;
  for (motion::MotionLimits* of : {&how.translation, &how.rotation})
    of->velocity *= scale, of->acceleration *= scale, of->jerk *= scale;
  how.reach.seed = options.common.seed, how.threads = options.common.threads;
  return with_remedy(motion::tool_space_path(chain, read.targets, preferred, limits, how, 1e-3 * options.step),
                     "--step, --tool-speed, --velocity, --acceleration or --jerk");
}

/// Of each joint that moves.
std::vector<bool> rotational_joints(const Chain& chain) {
  std::vector<bool> rotational;
  for (const int j : active_joints(chain))
    rotational.push_back(rotates(chain.joints[static_cast<std::size_t>(j)].type));
  return rotational;
}

Result<PathResult> plan(const PathArguments& options, const Chain& chain) {
  KINFER_TRY(limits, joint_limits(options, chain));
  if (!options.targets.empty()) return along_tool_lines(options, chain, limits);
  KINFER_TRY(postures, waypoints(options, chain));
  motion::JointPathOptions how{.stop_at_waypoints = options.stop, .most_cut = options.corner};
  how.cut_units.resize(dof(chain));
  for (int k = 0; const bool rotates : rotational_joints(chain)) how.cut_units[k++] = rotates ? degree : 1e-3;
  return with_remedy(motion::joint_space_path(chain, postures, limits, how, 1e-3 * options.step),
                     "--step, --velocity, --acceleration or --jerk");
}

/// Options that have no effect on this kind of path are refused.
Result<void> check_options(const CLI::App& verb, const PathArguments& options) {
  const bool in_joint_space = !options.from.empty() && !options.to.empty();
  if (in_joint_space == !options.targets.empty()) return error("expected either --from and --to, or --targets");
  const std::vector<std::string> idle = in_joint_space
                                            ? std::vector<std::string>{"--prefer", "--tool-speed", "--columns"}
                                            : std::vector<std::string>{"--from", "--via", "--to", "--corner", "--stop"};
  for (const std::string& option : idle)
    if (was_given(verb, option))
      return error("{} has no effect {} --targets", option, in_joint_space ? "without" : "with");
  if (options.stop && was_given(verb, "--corner")) return error("--corner has no effect with --stop");
  return {};
}

int run(const CLI::App& verb, const PathArguments& options) {
  if (const auto checked = check_options(verb, options); !checked) return fail(checked.error());
  if (const auto alone = expect_json_alone(options.common, options.out); !alone) return fail(alone.error());
  if (auto other = expect_other_file(options.out, {options.targets, options.chain.path, options.columns}); !other)
    return fail(other.error());
  const auto robot = read_robot(options.chain);
  if (!robot) return fail(robot.error());
  const Chain& chain = robot->chain;
  if (dof(chain) == 0) return fail({fmt::format("{}: the robot has no joint that moves", options.chain.path)});
  const auto result = plan(options, chain);
  if (!result) return fail(result.error());
  const std::vector<bool> rotational = rotational_joints(chain);
  const std::string text = format_path_csv(result->path, rotational);
  if (is_standard_output(options.out))
    print_data(text);
  else if (const auto done = write_text_file(options.out, text); !done)
    return fail(done.error());
  if (options.common.json)
    print_data(nlohmann::ordered_json{{"duration_s", result->path.duration},
                                      {"samples", result->path.time.size()},
                                      {"slowed_by", result->path.slowed_by},
                                      {"usable", !result->obstacle}}
                   .dump() +
               "\n");
  if (!options.common.quiet) {
    const std::vector<std::string> names = active_joint_names(chain);
    print_message("{}\n", words::summary(*result, rotational));
    if (result->obstacle) print_message("{}\n", words::sentence(*result->obstacle, names));
    if (!result->targets.empty()) print_unreached_targets(result->targets, names);
  }
  return result->obstacle ? exit_do_not_use : exit_done;
}

}  // namespace

Verb add_path(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "path", "A timed path through postures or tool targets, within the limits of the joints",
      "Postures are joined by straight lines in joint space, all joints in step; corners are cut as far as --corner\n"
      "allows. Targets are joined by straight lines of the tool, with a stop at each. Lists are in deg, and in mm for\n"
      "sliding joints. A path that leaves joint limits or passes a singular posture is written, named on standard\n"
      "error, and the exit code is 1.\nExamples:\n"
      "  kinfer path robot.toml --from 0,-90,90,0,45,0 --via 30,-80,80,0,45,0 --to 60,-90,90,0,45,0 -o "
      "path.csv\n"
      "  kinfer path robot.toml --targets targets.csv --tool-speed 100 -o path.csv");
  auto options = std::make_shared<PathArguments>();
  add_chain_option(*verb, options->chain);
  add_text(*verb, "--from", options->from, "First posture", Requirement::optional, "LIST");
  add_texts(*verb, "--via", options->via, "Postures between, in order", Requirement::optional, "LIST");
  add_text(*verb, "--to", options->to, "Last posture", Requirement::optional, "LIST");
  add_text(*verb, "--targets", options->targets, "Tool targets to be joined by straight lines, as of kinfer reach",
           Requirement::optional, "CSV");
  add_text(*verb, "--prefer", options->prefer, "With --targets: posture that the first target shall be near",
           Requirement::optional, "LIST");
  add_text(*verb, "-o,--out", options->out, "Where to write t, q1.., qd1.., qdd1.. (default: standard output)",
           Requirement::optional, "CSV");
  add_text(*verb, "--velocity", options->velocity, "Largest velocity of all joints or of each [deg/s, mm/s]",
           Requirement::optional, "LIST");
  add_text(*verb, "--acceleration", options->acceleration, "Largest acceleration [deg/s^2, mm/s^2]",
           Requirement::optional, "LIST");
  add_text(*verb, "--jerk", options->jerk, "Largest jerk [deg/s^3, mm/s^3]", Requirement::optional, "LIST");
  add_number(*verb, "--tool-speed", options->tool_speed, 1e-3, 1e5,
             "With --targets: speed of the tool [mm/s]; 250 mm/s go with 1 rad/s, four times of each per s, and so on");
  add_number(*verb, "--corner", options->corner, 0.0, 90.0,
             "By how much a corner may be cut, in the joint that misses its waypoint most; 0 stops there [deg, mm]");
  add_flag(*verb, "--stop", options->stop, "Stop at each posture instead of cutting corners");
  add_number(*verb, "--step", options->step, 0.1, 1e4, "Time between samples [ms]");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_common_options(*verb, options->common);
  return {verb, [verb, options] { return run(*verb, *options); }};
}

}  // namespace kinfer::cli
