// SPDX-License-Identifier: Apache-2.0
#include "studies/paper1/truth_errors.hpp"

#include <algorithm>
#include <cmath>

#include "studies/support/truth_geometry.hpp"

namespace kinfer::study::paper1_study {

GeometryErrors geometry_errors(const std::vector<JointEstimate>& estimates, const MachineTruth& truth) {
  GeometryErrors errors;
  const auto line_error = [](const Vec3& error, const Vec3& axis, const std::vector<Vec3>& unobservable) {
    return orthogonal_part(error, unobservable_basis(axis, unobservable)).norm();
  };
  for (const JointEstimate& joint : estimates) {
    if (joint.type == EstimatedJointType::rigid) continue;
    const auto is_same = [&](const JointTruth& t) { return t.parent == joint.parent && t.child == joint.child; };
    const auto t = std::ranges::find_if(truth.joints, is_same);
    if (t == truth.joints.end()) return {1e3, 1e3, 1e3};
    const AlignedJoint aligned = align_azimuth(joint, *t, truth);
    errors.azimuth = std::max(errors.azimuth, std::abs(aligned.azimuth));
    errors.direction = std::max({errors.direction, axis_angle(aligned.axis, t->axis_in_parent),
                                 axis_angle(joint.axis_in_child, t->axis_in_child)});
    errors.line = std::max(
        {errors.line, line_error(aligned.point - t->point_in_parent, t->axis_in_parent, t->unobservable_in_parent),
         line_error(joint.point_in_child - t->point_in_child, t->axis_in_child, t->unobservable_in_child)});
  }
  return errors;
}

}  // namespace kinfer::study::paper1_study
