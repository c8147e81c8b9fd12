// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compensate.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/deploy/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/kinematics/same_joints.hpp"
#include "kinfer/motion/reach.hpp"

namespace kinfer::deploy {
namespace {

InverseSolution solve_inverse(const Chain& chain, const ToolTarget& target, ConstVectorRef start, const Load& load) {
  if (!target.rotation) return inverse_position(chain, target.position, start, {}, load);
  return inverse(chain, {*target.rotation, target.position}, start, {}, load);
}

CompensatedJoints make_compensated(const InverseSolution& solution) {
  return {solution.q, solution.position_error, solution.angle_error, solution.status};
}

/// The corrected chain as it is at these joint positions.
Chain corrected_at(const Chain& corrected, const std::optional<PredictionModel>& prediction, ConstVectorRef q) {
  return prediction ? chain_with_corrections(corrected, *prediction, correction_weight(*prediction, q)) : corrected;
}

ReachTarget goal_of(const ToolTarget& target) {
  return {target.position, target.rotation ? OrientationGoal(FullGoal{*target.rotation}) : FreeOrientation{}};
}

/// Nominal joint positions for each target, dof x targets: the first posture inside the limits that reaches it, else
/// the closest.
MatrixXd nominal_postures(const Chain& nominal, const std::vector<ToolTarget>& targets, int threads,
                          std::uint64_t seed) {
  std::vector<ReachTarget> goals;
  for (const ToolTarget& target : targets) goals.push_back(goal_of(target));
  motion::ReachOptions options;
  options.seed = seed;
  const auto found = motion::reach(nominal, goals, motion::middle_posture(nominal), options, threads);
  MatrixXd postures(dof(nominal), targets.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    postures.col(static_cast<Eigen::Index>(i)) = found[i].postures.front().q;
  return postures;
}

/// In the posture nearest to `preferred` that the chain can take: what the nominal robot reaches in one posture, the
/// real one may reach only in another.
CompensatedJoints compensate_in_any_posture(const Chain& corrected, const std::optional<PredictionModel>& prediction,
                                            const ToolTarget& target, const VectorXd& preferred, std::uint64_t seed,
                                            const Load& load) {
  motion::ReachOptions options;
  options.choice = motion::PostureChoice::nearest;
  options.seed = seed;
  const Chain there = corrected_at(corrected, prediction, preferred);
  const VectorXd posture = motion::ReachSolver(there, options).solve(goal_of(target), preferred).postures.front().q;
  return make_compensated(solve_inverse(corrected_at(corrected, prediction, posture), target, posture, load));
}

}  // namespace

CompensationFrames select_compensation_frames(const Chain& corrected, const Chain& nominal,
                                              const Tolerances& tolerances) {
  const Pose a = corrected.base.pose(), b = nominal.base.pose();
  const bool moved = (a.position - b.position).norm() > thresholds::frames_apart * tolerances.base_length ||
                     angle_between(a.rotation, b.rotation) > thresholds::frames_apart * tolerances.base_angle;
  return moved ? CompensationFrames::robot : CompensationFrames::as_given;
}

Chain express_in_frames(Chain corrected, const Chain& nominal, CompensationFrames frames) {
  if (frames == CompensationFrames::as_given) return corrected;
  // Gravity is in the world that the base leaves: it stays what it is in the base, by which joints yield to loads.
  corrected.gravity = nominal.base.pose().rotation * corrected.base.pose().rotation.transpose() * corrected.gravity;
  corrected.base = nominal.base;
  corrected.tool = nominal.tool;
  return corrected;
}

std::optional<PredictionModel> express_in_frames(std::optional<PredictionModel> prediction, CompensationFrames frames) {
  if (!prediction || frames == CompensationFrames::as_given || prediction->beyond.size() == 0) return prediction;
  for (std::size_t k = 0; k < prediction->parameters.size(); ++k)
    if (prediction->parameters[k].starts_with("base_") || prediction->parameters[k].starts_with("tool_"))
      prediction->beyond[static_cast<Eigen::Index>(k)] = 0.0;
  return prediction;
}

Result<CompensationModels> prepare_compensation(const Chain& corrected, const Chain& nominal,
                                                const Tolerances& tolerances, std::optional<CompensationFrames> frames,
                                                const std::optional<PredictionModel>& prediction) {
  if (!have_same_joints(corrected, nominal))
    return error("the corrected and the nominal model need joints of the same number and types");
  const CompensationFrames used = frames.value_or(select_compensation_frames(corrected, nominal, tolerances));
  return CompensationModels{express_in_frames(corrected, nominal, used), nominal, used,
                            express_in_frames(prediction, used)};
}

Result<void> expect_own_mounting(const Chain& corrected, const PoseSet& rows) {
  PoseSet groups;  // without measurements, whose fixtures do not matter here
  groups.joints = rows.joints;
  static_cast<RowGroups&>(groups) = rows;
  KINFER_TRY(placed, calibrate::with_fixtures(corrected, groups));
  const auto other = std::ranges::find_if(placed.data.mounting, [](int mounting) { return mounting >= 0; });
  if (other == placed.data.mounting.end()) return {};
  return error(
      "rows name \"{}\", another set-up or arm than that of the model, whose base and tool are used for all rows: "
      "leave these rows out",
      placed.chain.mountings[static_cast<std::size_t>(*other)].name);
}

std::vector<CompensatedJoints> compensate_joints(const Chain& corrected, const Chain& nominal, const MatrixXd& q,
                                                 int threads, const std::optional<PredictionModel>& prediction) {
  PoseSet rows;
  rows.joints = q;
  return compensate_joints(corrected, nominal, rows, threads, prediction);
}

std::vector<CompensatedJoints> compensate_joints(const Chain& corrected, const Chain& nominal, const PoseSet& given,
                                                 int threads, const std::optional<PredictionModel>& prediction) {
  const PoseSet rows = with_approach(given);
  const MatrixXd& q = rows.joints;
  KINFER_EXPECT(q.rows() == dof(corrected) && q.rows() == dof(nominal), "{} joint positions for {} and {} joints",
                q.rows(), dof(corrected), dof(nominal));
  std::vector<CompensatedJoints> list(q.cols());
  const bool full_pose = q.rows() >= thresholds::joints_for_full_pose;
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    const VectorXd start = q.col(row);
    const Pose wanted = forward(nominal, start, load_at(nominal, rows, row));
    ToolTarget target{wanted.position, std::nullopt};
    if (full_pose) target.rotation = wanted.rotation;
    list[i] = make_compensated(
        solve_inverse(corrected_at(corrected, prediction, start), target, start, load_at(corrected, rows, row)));
  });
  return list;
}

std::vector<CompensatedJoints> compensate_targets(const Chain& corrected, const Chain& nominal,
                                                  const std::vector<ToolTarget>& targets, const MatrixXd& start,
                                                  int threads, std::uint64_t seed,
                                                  const std::optional<PredictionModel>& prediction,
                                                  const PoseSet& loads) {
  const MatrixXd drawn = start.cols() > 0 ? MatrixXd() : nominal_postures(nominal, targets, threads, seed);
  std::vector<CompensatedJoints> list(targets.size());
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const auto column = static_cast<Eigen::Index>(i);
    const VectorXd first =
        start.cols() > 0 ? solve_inverse(nominal, targets[i], start.col(column), load_at(nominal, loads, column)).q
                         : VectorXd(drawn.col(column));
    const Load load = load_at(corrected, loads, column);
    list[i] = make_compensated(solve_inverse(corrected_at(corrected, prediction, first), targets[i], first, load));
    if (list[i].status == InverseStatus::reached || start.cols() > 0) return;
    CompensatedJoints other = compensate_in_any_posture(corrected, prediction, targets[i], first, seed, load);
    if (other.status == InverseStatus::reached) list[i] = std::move(other);
  });
  return list;
}

}  // namespace kinfer::deploy
