// SPDX-License-Identifier: Apache-2.0
// kinfer reach: joint positions at which the tool of any chain meets given targets.
#include "kinfer/motion/reach.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/joint_columns.hpp"
#include "kinfer/cli/options/posture_argument.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/parts/unreached_targets.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/motion/reach_targets_csv.hpp"

namespace kinfer::cli {
namespace {

struct ReachArguments {
  CommonOptions common;
  RobotOption chain;
  std::string targets, columns, out, postures = "first", tool_axis = "z", prefer;
  bool sequence = false;
  int starts = 200;
};

Vec3 axis_named(const std::string& name) {
  const Vec3 axis = name.back() == 'x' ? Vec3::UnitX() : name.back() == 'y' ? Vec3::UnitY() : Vec3::UnitZ();
  return name.front() == '-' ? Vec3(-axis) : axis;
}

motion::PostureChoice choice_named(const std::string& name) {
  if (name == "all") return motion::PostureChoice::all;
  return name == "nearest" ? motion::PostureChoice::nearest : motion::PostureChoice::first;
}

/// --prefer, else the joint columns of the targets, else the middle of the limits.
Result<MatrixXd> preferred_postures(const ReachArguments& options, const Chain& chain, const ReachTargets& read) {
  if (!options.prefer.empty()) {
    KINFER_TRY(posture, parse_posture("--prefer", options.prefer, chain));
    return MatrixXd(posture);
  }
  return read.preferred.size() > 0 ? read.preferred : MatrixXd(motion::middle_posture(chain));
}

int run(const ReachArguments& options) {
  if (auto other = expect_other_file(options.out, {options.targets, options.chain.path, options.columns}); !other)
    return fail(other.error());
  if (const auto alone = expect_json_alone(options.common, options.out); !alone) return fail(alone.error());
  const auto robot = read_robot(options.chain);
  if (!robot) return fail(robot.error());
  if (dof(robot->chain) == 0) return fail({fmt::format("{}: the robot has no joint that moves", options.chain.path)});
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  const auto read = read_reach_targets(options.targets, robot->chain, *map);
  if (!read) return fail(read.error());
  const auto preferred = preferred_postures(options, robot->chain, *read);
  if (!preferred) return fail(preferred.error());
  const motion::ReachOptions how{.choice = choice_named(options.postures),
                                 .starts = options.starts,
                                 .tool_axis = axis_named(options.tool_axis),
                                 .seed = options.common.seed};
  const std::vector<ReachSolution> solutions =
      options.sequence ? motion::reach_in_sequence(robot->chain, read->targets, preferred->col(0), how)
                       : motion::reach(robot->chain, read->targets, *preferred, how, options.common.threads);
  const std::vector<std::string> names = active_joint_names(robot->chain);
  const std::string text = format_postures_csv(solutions, joint_columns(options.targets, names));
  if (is_standard_output(options.out))
    print_data(text);
  else if (const auto done = write_text_file(options.out, text); !done)
    return fail(done.error());
  const ReachSummary summary = summarise(solutions);
  if (options.common.json)
    print_data(nlohmann::ordered_json{{"targets", summary.targets},
                                      {"reached", summary.targets - static_cast<int>(summary.unreached.size())},
                                      {"postures", summary.postures}}
                   .dump() +
               "\n");
  if (!options.common.quiet) print_unreached_targets(solutions, names);
  return summary.unreached.empty() ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_reach(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "reach", "Joint positions at which the tool meets given targets (inverse kinematics)",
      "A target is a point x,y,z with, where wanted, a full orientation (qw,qx,qy,qz), a direction of the tool axis\n"
      "(axis_i,axis_j,axis_k) or its pitch above the horizontal plane. Targets that no posture inside the joint "
      "limits\n"
      "reaches are named with the reason on standard error, and the exit code is 1.\nExamples:\n"
      "  kinfer reach machine --targets targets.csv -o joints.csv\n"
      "  kinfer reach robot.toml --targets targets.csv --postures all\n"
      "  kinfer reach robot.urdf --targets path.csv --sequence --prefer 0,-90,90,0,45,0");
  auto options = std::make_shared<ReachArguments>();
  add_chain_option(*verb, options->chain);
  add_text(*verb, "--targets", options->targets,
           "Wanted tool points and orientations; joint columns q1.. are the preferred postures", Requirement::required,
           "CSV");
  add_text(*verb, "-o,--out", options->out,
           "Where to write target, posture, status, joint positions and errors (default: standard output)",
           Requirement::optional, "CSV");
  add_choice(*verb, "--postures", options->postures, {"first", "nearest", "all"},
             "first: the first found, from the preferred posture; nearest: of all found; all: nearest first");
  add_text(*verb, "--prefer", options->prefer,
           "Posture to stay near, in deg and mm: 0,-90,90,0,45,0 (default: the targets' joint columns, else the middle "
           "of the limits)",
           Requirement::optional, "LIST");
  add_flag(*verb, "--sequence", options->sequence, "Each target prefers the posture of the one before it");
  add_choice(*verb, "--tool-axis", options->tool_axis, {"x", "y", "z", "-x", "-y", "-z"},
             "Axis of the tool frame that axis_i,axis_j,axis_k and pitch direct");
  add_count(*verb, "--starts", options->starts, 1, 100000, "Starts of the search; more: misses fewer postures");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
