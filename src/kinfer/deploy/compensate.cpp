// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compensate.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/deploy/thresholds.hpp"
#include "kinfer/kinematics/same_joints.hpp"

namespace kinfer::deploy {
namespace {

InverseSolution solve_inverse(const Chain& chain, const ToolTarget& target, ConstVectorRef start) {
  if (!target.rotation) return inverse_position(chain, target.position, start);
  return inverse(chain, {*target.rotation, target.position}, start);
}

CompensatedJoints make_compensated(const InverseSolution& solution) {
  return {solution.q, solution.position_error, solution.angle_error, solution.status};
}

double total_error(const InverseSolution& solution) {
  return solution.position_error + solution.angle_error;
}

/// Random joint positions inside the limits and inside ±170° or ±0.5 m.
VectorXd draw_configuration(const Chain& chain, Rng rng) {
  const std::vector<int> moving = active_joints(chain);
  VectorXd q(moving.size());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const Joint& joint = chain.joints[moving[k]];
    const double reach = rotates(joint.type) ? 170.0 * degree : thresholds::reach_translation;
    q[k] = rng.uniform(std::max(joint.lower, -reach), std::min(joint.upper, reach));
  }
  return q;
}

/// The nominal joint positions for a target: the first solution that reaches it, else the closest one.
VectorXd nominal_solution(const Chain& nominal, const ToolTarget& target, Rng rng) {
  std::optional<InverseSolution> best;
  for (int i = 0; i < thresholds::inverse_attempts; ++i) {
    const InverseSolution solution = solve_inverse(nominal, target, draw_configuration(nominal, rng.stream(i)));
    if (!best || total_error(solution) < total_error(*best)) best = solution;
    if (best->status == InverseStatus::reached) break;
  }
  return best->q;
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
  corrected.base = nominal.base;
  corrected.tool = nominal.tool;
  return corrected;
}

Result<CompensationModels> prepare_compensation(const Chain& corrected, const Chain& nominal,
                                                const Tolerances& tolerances,
                                                std::optional<CompensationFrames> frames) {
  if (!have_same_joints(corrected, nominal))
    return error("the corrected and the nominal model need joints of the same number and types");
  const CompensationFrames used = frames.value_or(select_compensation_frames(corrected, nominal, tolerances));
  return CompensationModels{express_in_frames(corrected, nominal, used), nominal, used};
}

std::vector<CompensatedJoints> compensate_joints(const Chain& corrected, const Chain& nominal, const MatrixXd& q,
                                                 int threads) {
  KINFER_EXPECT(q.rows() == dof(corrected) && q.rows() == dof(nominal), "{} joint positions for {} and {} joints",
                q.rows(), dof(corrected), dof(nominal));
  std::vector<CompensatedJoints> list(q.cols());
  const bool full_pose = q.rows() >= thresholds::joints_for_full_pose;
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const VectorXd start = q.col(static_cast<Eigen::Index>(i));
    const Pose wanted = forward(nominal, start);
    ToolTarget target{wanted.position, std::nullopt};
    if (full_pose) target.rotation = wanted.rotation;
    list[i] = make_compensated(solve_inverse(corrected, target, start));
  });
  return list;
}

std::vector<CompensatedJoints> compensate_targets(const Chain& corrected, const Chain& nominal,
                                                  const std::vector<ToolTarget>& targets, const MatrixXd& start,
                                                  int threads, Rng rng) {
  std::vector<CompensatedJoints> list(targets.size());
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const VectorXd first = start.cols() > 0
                               ? VectorXd(solve_inverse(nominal, targets[i], start.col(static_cast<Eigen::Index>(i))).q)
                               : nominal_solution(nominal, targets[i], rng.stream(i));
    list[i] = make_compensated(solve_inverse(corrected, targets[i], first));
  });
  return list;
}

}  // namespace kinfer::deploy
