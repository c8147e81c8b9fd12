// SPDX-License-Identifier: Apache-2.0
// kinfer compensate: joint targets that bring the real tool to the pose of the nominal model or to a target.
#include "kinfer/deploy/compensate.hpp"
#include "kinfer/deploy/predict.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/cli/options/joint_columns.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer::cli {
namespace {

struct CompensateArguments {
  CommonOptions common;
  RobotOption chain;
  std::string nominal, joints, targets, out, frames = "auto";
};

std::string result_csv(const std::vector<JointColumn>& columns, const std::vector<CompensatedJoints>& list) {
  std::string text;
  for (const JointColumn& column : columns) text += column.header + ",";
  text += "residual[mm]\n";
  for (const CompensatedJoints& row : list) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      text += format_number(row.q[static_cast<Eigen::Index>(k)], columns[k].factor) + ",";
    text += format_number(row.residual, 1e-3) + "\n";
  }
  return text;
}

std::vector<deploy::ToolTarget> targets_of(const PoseSet& set) {
  std::vector<deploy::ToolTarget> targets(set.rows());
  for (const PointMeasurement& point : set.points) targets[point.row].position = point.position;
  for (const OrientationMeasurement& m : set.orientations) targets[m.row].rotation = m.orientation.toRotationMatrix();
  return targets;
}

std::optional<deploy::CompensationFrames> frames_of(const std::string& name) {
  if (name == "world") return deploy::CompensationFrames::as_given;
  if (name == "robot") return deploy::CompensationFrames::robot;
  return std::nullopt;
}

Result<deploy::CompensationModels> read_models(const CompensateArguments& options) {
  KINFER_TRY(corrected, read_robot(options.chain));
  KINFER_TRY(nominal, read_robot({options.nominal, options.chain.base_link, options.chain.tip_link}));
  auto models = deploy::prepare_compensation(corrected.chain, nominal.chain, nominal.tolerances,
                                             frames_of(options.frames), corrected.prediction);
  if (!models) return error("{}, {}: {}", options.chain.path, options.nominal, models.error().what);
  return models;
}

Result<std::vector<CompensatedJoints>> compensated_rows(const CompensateArguments& options,
                                                        const deploy::CompensationModels& chains) {
  const int threads = options.common.threads;
  if (!options.joints.empty()) {
    KINFER_TRY(set, read_pose_set(options.joints, chains.nominal, {}, RequiredContent::joints_only));
    if (auto own = deploy::expect_own_mounting(chains.corrected, set); !own) return forward_error(own.error());
    return deploy::compensate_joints(chains.corrected, chains.nominal, set, threads, chains.prediction);
  }
  KINFER_TRY(set, read_pose_set(options.targets, chains.nominal, {}, RequiredContent::targets));
  if (auto own = deploy::expect_own_mounting(chains.corrected, set); !own) return forward_error(own.error());
  const MatrixXd start = set.joints.rows() > 0 ? set.joints : MatrixXd();
  return deploy::compensate_targets(chains.corrected, chains.nominal, targets_of(set), start, threads,
                                    options.common.seed, chains.prediction, set);
}

/// Reports the rows that are not reached, and why.
void print_summary(const CompensationSummary& summary, const std::vector<CompensatedJoints>& list) {
  constexpr std::size_t most = 12;  // rows listed individually
  for (std::size_t i = 0; i < std::min(most, summary.unreached.size()); ++i)
    print_message("{}\n", words::unreached_row(summary.unreached[i], list[summary.unreached[i]]));
  if (summary.unreached.size() > most) print_message("and {} more\n", summary.unreached.size() - most);
  print_message("{}\n", words::summary(summary));
}

/// Warns of compensated joint positions that the calibration did not measure.
void warn_of_rows_outside(const CompensateArguments& options, const std::vector<CompensatedJoints>& list) {
  const auto corrected = read_robot(options.chain);
  if (!corrected || !corrected->prediction || list.empty()) return;
  PoseSet rows;
  rows.joints.resize(list.front().q.size(), static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) rows.joints.col(static_cast<Eigen::Index>(i)) = list[i].q;
  if (const auto outside = deploy::find_rows_outside(*corrected->prediction, rows))
    print_message("{}\n", words::sentence(*outside));
}

int run(const CompensateArguments& options) {
  if (options.joints.empty() == options.targets.empty()) return fail({"expected either --joints or --targets"});
  if (const auto alone = expect_json_alone(options.common, options.out); !alone) return fail(alone.error());
  if (auto other =
          expect_other_file(options.out, {options.joints, options.targets, options.nominal, options.chain.path});
      !other)
    return fail(other.error());
  const auto chains = read_models(options);
  if (!chains) return fail(chains.error());
  const auto list = compensated_rows(options, *chains);
  if (!list) return fail(list.error());
  if (options.frames == "auto" && chains->frames == deploy::CompensationFrames::robot && !options.common.quiet)
    print_message("{}\n", words::compensation_frames_note());
  const std::string& input = options.joints.empty() ? options.targets : options.joints;
  const std::string text = result_csv(joint_columns(input, active_joint_names(chains->nominal)), *list);
  if (is_standard_output(options.out))
    print_data(text);
  else if (auto done = write_text_file(options.out, text); !done)
    return fail(done.error());
  const CompensationSummary summary = summarise(*list);
  if (options.common.json)
    print_data(nlohmann::ordered_json{{"rows", summary.rows},
                                      {"unreached", summary.unreached.size()},
                                      {"worst_residual_mm", 1e3 * summary.worst_residual}}
                   .dump() +
               "\n");
  if (!options.common.quiet) print_summary(summary, *list);
  if (!options.common.quiet) warn_of_rows_outside(options, *list);
  return summary.unreached.empty() ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_compensate(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "compensate", "Joint targets that put the real tool where the nominal model, or a target, wants it",
      "Rows that cannot be reached are said on standard error, and the exit code is 1.\nExample:\n"
      "  kinfer compensate --chain calibration/chain.toml --nominal robot.toml --joints joints.csv -o corrected.csv");
  auto options = std::make_shared<CompensateArguments>();
  add_chain_option(*verb, options->chain, "Corrected model: chain.toml or the folder it is in, URDF or MJCF");
  add_model_file(*verb, "--nominal", options->nominal, "Model that the robot's controller has", Requirement::required,
                 "ROBOT");
  add_text(*verb, "--joints", options->joints, "Joint lists as the controller would send them", Requirement::optional,
           "CSV");
  add_text(*verb, "--targets", options->targets,
           "Wanted tool poses: x,y,z, with or without qw,qx,qy,qz and joint positions to start from",
           Requirement::optional, "CSV");
  add_text(*verb, "-o,--out", options->out,
           "Where to write the corrected joint positions and residual[mm] (default: standard output)",
           Requirement::optional, "CSV");
  add_choice(*verb, "--frames", options->frames, {"auto", "world", "robot"},
             "world: base and tool as the files say; robot: the nominal ones for both");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
