// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/compare.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/deploy/thresholds.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/poses/pose_constraints.hpp"
#include "kinfer/kinematics/same_joints.hpp"

namespace kinfer::deploy {
namespace {

/// Relative rotation of a URDF joint's origin: its component rx, ry or rz (intrinsic) [rad].
double rotation_change(const Chain& earlier, const Chain& later, const JointNumber& at) {
  const auto& before = std::get<UrdfLink>(earlier.joints[at.joint].link);
  const auto& after = std::get<UrdfLink>(later.joints[at.joint].link);
  const Vec3 turn = to_intrinsic_xyz(before.origin.pose().rotation.transpose() * after.origin.pose().rotation);
  return turn[static_cast<int>(at.field) - static_cast<int>(Field::rx)];
}

double change_of(const Chain& earlier, const Chain& later, const Parameter& p) {
  if (const JointNumber* number = joint_number(p.at); number && is_rotation(number->field))
    return rotation_change(earlier, later, *number);
  double change = value_at(later, p.at) - value_at(earlier, p.at);
  if (p.quantity == Quantity::angle) change = wrap_to_pi(change);
  return change;
}

/// Holm's test: the k-th smallest p-value (k from 0) must be below risk / (n − k), and so must all smaller ones.
void mark_significant(std::vector<ParameterChange>& sorted) {
  const auto n = static_cast<double>(sorted.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const double p_value = 2.0 * (1.0 - normal_cdf(std::abs(sorted[k].sigmas)));
    if (p_value > thresholds::changed_risk / (n - static_cast<double>(k))) return;
    sorted[k].significant = true;
  }
}

/// Distances between the tools of both chains over the joint ranges, after the best rigid alignment: a change that
/// another placement of the instrument would explain does not count.
std::vector<double> tool_displacements(const Chain& earlier, Chain later) {
  later.base = earlier.base, later.tool = earlier.tool;
  const auto drawn = draw_poses(earlier, {}, thresholds::compared_poses, Rng(1));
  if (!drawn) return {};
  std::vector<Vec3> before, after;
  for (Eigen::Index i = 0; i < drawn->cols(); ++i) {
    before.push_back(forward(earlier, drawn->col(i)).position);
    after.push_back(forward(later, drawn->col(i)).position);
  }
  const Pose aligned = align_points(before, after);
  std::vector<double> distance;
  for (std::size_t i = 0; i < before.size(); ++i) distance.push_back((before[i] - aligned * after[i]).norm());
  return distance;
}

}  // namespace

Result<CalibrationComparison> compare_calibrations(const CalibratedRobot& earlier, const CalibratedRobot& later) {
  if (!have_same_joints(earlier.chain, later.chain)) return error("the two chains do not have the same joints");
  CalibrationComparison changes;
  for (const Parameter& p : all_parameters(earlier.chain, {}).parameters) {
    const auto before = earlier.sd.find(p.name), after = later.sd.find(p.name);
    if (!is_joint_parameter(p.at) || before == earlier.sd.end() || after == later.sd.end()) continue;
    ParameterChange c{.name = p.name, .quantity = p.quantity};
    c.before = value_at(earlier.chain, p.at), c.after = value_at(later.chain, p.at);
    c.change = change_of(earlier.chain, later.chain, p);
    c.sd = std::hypot(before->second, after->second);
    c.sigmas = c.sd > 0.0 ? c.change / c.sd : 0.0;
    changes.parameters.push_back(c);
  }
  if (changes.parameters.empty())
    return error("no joint parameter has a standard deviation (a_sd, theta_sd, ...) in both chains");
  std::stable_sort(changes.parameters.begin(), changes.parameters.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.sigmas) > std::abs(b.sigmas); });
  mark_significant(changes.parameters);
  const std::vector<double> displacements = tool_displacements(earlier.chain, later.chain);
  if (!displacements.empty()) {
    changes.tool_rms = rms(displacements);
    changes.tool_worst = *std::max_element(displacements.begin(), displacements.end());
  }
  changes.changed = changes.parameters.front().significant;
  return changes;
}

}  // namespace kinfer::deploy
