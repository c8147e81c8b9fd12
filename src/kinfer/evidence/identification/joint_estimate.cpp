// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/identification/joint_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/evidence/identification/unobservable_limit.hpp"

namespace kinfer {

bool is_axis_known(const JointEstimate& joint, const std::array<double, 2>& axis_sd) {
  return joint.type != EstimatedJointType::spherical && std::min(axis_sd[0], axis_sd[1]) < unobservable_sd;
}

bool is_point_known(const std::array<double, 2>& point_sd, const std::vector<Vec3>& unobservable) {
  const double least = std::min(point_sd[0], point_sd[1]);
  if (!std::isfinite(least) || unobservable.size() >= 3) return false;
  return least < unobservable_sd || !unobservable.empty();  // what is known lies across the unobservable directions
}

bool is_direction_known(const JointEstimate& joint) {
  return joint.type == EstimatedJointType::spherical || joint.azimuth_unobservable ||
         is_axis_known(joint, joint.sd.axis_in_child);
}

bool is_line_known(const JointEstimate& joint) {
  return joint.unobservable_in_child.size() < 3
             ? is_point_known(joint.sd.point_in_child, joint.unobservable_in_child)
             : is_point_known(joint.sd.point_in_parent, joint.unobservable_in_parent);
}

std::string joint_name(const JointEstimate& joint) {
  return joint.parent + "-" + joint.child;
}

double type_probability(const JointEstimate& joint) {
  return joint.type_probabilities ? joint.type_probabilities->of(joint.type) : 1.0;
}

double probability_of_types(const std::vector<JointEstimate>& joints) {
  double all = 1.0;
  for (const JointEstimate& joint : joints) all *= type_probability(joint);
  return all;
}

bool is_one_body(const std::vector<JointEstimate>& joints) {
  return std::ranges::all_of(joints, [](const JointEstimate& j) { return j.type == EstimatedJointType::rigid; });
}

bool is_determined(const JointForecast& forecast) {
  return std::isfinite(forecast.line_sd) && std::isfinite(forecast.direction_sd);
}

bool all_sufficient(const std::vector<JointForecast>& joints) {
  return std::ranges::all_of(joints, &JointForecast::is_sufficient);
}

}  // namespace kinfer
