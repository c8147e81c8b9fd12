// SPDX-License-Identifier: Apache-2.0
// How an estimated joint differs from the true one, without unobservable directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study {

/// Orthonormal basis of a point's unobservable directions: along the axis, and those that the truth lists.
inline std::vector<Vec3> unobservable_basis(const Vec3& axis, const std::vector<Vec3>& unobservable) {
  std::vector<Vec3> basis;
  const auto add = [&](Vec3 direction) {
    for (const Vec3& b : basis) direction -= b * b.dot(direction);
    if (direction.norm() > 1e-3) basis.push_back(direction.normalized());
  };
  add(axis);
  for (const Vec3& direction : unobservable) add(direction);
  return basis;
}

/// The part of `error` that is orthogonal to an orthonormal basis.
inline Vec3 orthogonal_part(Vec3 error, const std::vector<Vec3>& basis) {
  for (const Vec3& b : basis) error -= b * b.dot(error);
  return error;
}

/// Angle between two lines through one point [rad].
inline double axis_angle(const Vec3& a, const Vec3& b) {
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

/// Rotation about the body's incoming axis that brings the estimated outgoing axis nearest to the true one [rad].
inline double azimuth_correction(const JointTruth& incoming, const JointTruth& outgoing,
                                 const JointEstimate& estimate) {
  const Vec3 n = incoming.axis_in_child;
  const auto flat = [&](const Vec3& v) { return Vec3(v - n * n.dot(v)); };
  Vec3 estimated = estimate.axis_in_parent, expected = outgoing.axis_in_parent;
  if (estimated.dot(expected) < 0.0) estimated = -estimated;
  if (flat(expected).norm() < 0.2) {
    estimated = estimate.point_in_parent - incoming.point_in_child;
    expected = outgoing.point_in_parent - incoming.point_in_child;
  }
  estimated = flat(estimated), expected = flat(expected);
  return std::atan2(n.dot(estimated.cross(expected)), estimated.dot(expected));
}

/// An estimated joint in its parent's frame; where the parent has one axis only, rotated about it to the best fit.
struct AlignedJoint {
  Vec3 axis, point;
  double azimuth = 0.0;  ///< [rad] rotation that was applied
  bool azimuth_is_free = false;
};
inline AlignedJoint align_azimuth(const JointEstimate& estimate, const JointTruth& joint, const MachineTruth& truth) {
  AlignedJoint aligned{.axis = estimate.axis_in_parent, .point = estimate.point_in_parent};
  const auto incoming = std::ranges::find(truth.joints, joint.parent, &JointTruth::child);
  aligned.azimuth_is_free = incoming != truth.joints.end() && joint.unobservable_in_parent.size() == 1;
  if (!aligned.azimuth_is_free) return aligned;
  aligned.azimuth = azimuth_correction(*incoming, joint, estimate);
  const Mat3 r = exp_so3(aligned.azimuth * incoming->axis_in_child);
  aligned.axis = r * aligned.axis;
  aligned.point = incoming->point_in_child + r * (aligned.point - incoming->point_in_child);
  return aligned;
}

}  // namespace kinfer::study
