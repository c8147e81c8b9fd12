// SPDX-License-Identifier: Apache-2.0
#include "studies/paper1/truth_errors.hpp"

#include <algorithm>
#include <cmath>

#include "studies/support/truth_geometry.hpp"

namespace kinfer::study {

GeometryErrors geometry_errors(const std::vector<JointEstimate>& found, const MachineTruth& truth) {
  GeometryErrors errors;
  for (const JointEstimate& joint : found) {
    if (joint.type == EstimatedJointType::rigid) continue;
    const auto is_it = [&](const JointTruth& t) { return t.parent == joint.parent && t.child == joint.child; };
    const auto t = std::ranges::find_if(truth.joints, is_it);
    if (t == truth.joints.end()) return {1e3, 1e3, 1e3};
    Vec3 axis = joint.axis_in_parent, point = joint.point_in_parent;
    const auto incoming = std::ranges::find(truth.joints, joint.parent, &JointTruth::child);
    if (incoming != truth.joints.end() && t->unobservable_in_parent.size() == 1) {
      const double turn = best_turn(*incoming, *t, joint);
      const Mat3 r = exp_so3(turn * incoming->axis_in_child);
      axis = r * axis;
      point = incoming->point_in_child + r * (point - incoming->point_in_child);
      errors.azimuth = std::max(errors.azimuth, std::abs(turn));
    }
    errors.direction = std::max(
        {errors.direction, axis_angle(axis, t->axis_in_parent), axis_angle(joint.axis_in_child, t->axis_in_child)});
    errors.line = std::max(
        {errors.line,
         across(point - t->point_in_parent, unknowable(t->axis_in_parent, t->unobservable_in_parent)).norm(),
         across(joint.point_in_child - t->point_in_child, unknowable(t->axis_in_child, t->unobservable_in_child))
             .norm()});
  }
  return errors;
}

}  // namespace kinfer::study
