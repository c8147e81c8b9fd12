#include "kinfer/calibrate/compensate.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

constexpr int joints_to_turn_freely = 6;

InverseSolution solved(const Chain& chain, const ToolTarget& target, ConstVectorRef start) {
  if (!target.rotation) return inverse_position(chain, target.position, start);
  return inverse(chain, {*target.rotation, target.position}, start);
}

Compensated compensated(const InverseSolution& solution) {
  return {solution.q, solution.position_error, solution.angle_error, solution.reach};
}

double total_error(const InverseSolution& solution) {
  return solution.position_error + solution.angle_error;
}

/// Readings inside the limits; ±170° or ±0.5 m where a joint has none.
VectorXd drawn_posture(const Chain& chain, Rng rng) {
  const std::vector<int> moving = joints_with_reading(chain);
  VectorXd q(moving.size());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const Joint& joint = chain.joints[moving[k]];
    const double reach = joint.type == JointType::revolute ? 170.0 * degree : 0.5;
    q[k] = rng.uniform(std::max(joint.lower, -reach), std::min(joint.upper, reach));
  }
  return q;
}

/// The nominal readings for a target: the first posture from which it is reached, else the one that comes closest.
VectorXd nominal_solution(const Chain& nominal, const ToolTarget& target, Rng rng) {
  constexpr int postures = 60;
  std::optional<InverseSolution> best;
  for (int i = 0; i < postures; ++i) {
    const InverseSolution solution = solved(nominal, target, drawn_posture(nominal, rng.stream(i)));
    if (!best || total_error(solution) < total_error(*best)) best = solution;
    if (best->reach == Reach::reached) break;
  }
  return best->q;
}

}  // namespace

CompensationFrames believable_frames(const Chain& corrected, const Chain& nominal, const Tolerances& tolerances) {
  constexpr double tolerances_apart = 3.0;
  const Pose a = corrected.base.pose(), b = nominal.base.pose();
  const bool moved = (a.position - b.position).norm() > tolerances_apart * tolerances.base_length ||
                     angle_between(a.rotation, b.rotation) > tolerances_apart * tolerances.base_angle;
  return moved ? CompensationFrames::robot : CompensationFrames::as_given;
}

Chain in_frames(Chain corrected, const Chain& nominal, CompensationFrames frames) {
  if (frames == CompensationFrames::as_given) return corrected;
  corrected.base = nominal.base;
  corrected.tool = nominal.tool;
  return corrected;
}

std::vector<Compensated> compensate_joints(const Chain& corrected, const Chain& nominal, const MatrixXd& q,
                                           int threads) {
  KINFER_EXPECT(q.rows() == dof(corrected) && q.rows() == dof(nominal), "{} readings for {} and {} joints", q.rows(),
                dof(corrected), dof(nominal));
  std::vector<Compensated> list(q.cols());
  const bool turns_freely = q.rows() >= joints_to_turn_freely;
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const VectorXd start = q.col(static_cast<Eigen::Index>(i));
    const Pose wanted = forward(nominal, start);
    ToolTarget target{wanted.position, std::nullopt};
    if (turns_freely) target.rotation = wanted.rotation;
    list[i] = compensated(solved(corrected, target, start));
  });
  return list;
}

std::vector<Compensated> compensate_targets(const Chain& corrected, const Chain& nominal,
                                            const std::vector<ToolTarget>& targets, const MatrixXd& start, int threads,
                                            Rng rng) {
  std::vector<Compensated> list(targets.size());
  parallel_for(list.size(), threads, [&](std::size_t i) {
    const VectorXd first = start.cols() > 0
                               ? VectorXd(solved(nominal, targets[i], start.col(static_cast<Eigen::Index>(i))).q)
                               : nominal_solution(nominal, targets[i], rng.stream(i));
    list[i] = compensated(solved(corrected, targets[i], first));
  });
  return list;
}

}  // namespace kinfer
