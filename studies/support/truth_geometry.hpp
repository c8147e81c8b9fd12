// SPDX-License-Identifier: Apache-2.0
// How a found joint differs from the true one, leaving aside what no signal tells.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/evidence/identification.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study {

/// Basis of what cannot be known of a point: the axis and the hidden directions, orthonormal.
inline std::vector<Vec3> unknowable(const Vec3& axis, const std::vector<Vec3>& hidden) {
  std::vector<Vec3> basis;
  const auto add = [&](Vec3 direction) {
    for (const Vec3& b : basis) direction -= b * b.dot(direction);
    if (direction.norm() > 1e-3) basis.push_back(direction.normalized());
  };
  add(axis);
  for (const Vec3& direction : hidden) add(direction);
  return basis;
}

/// What is left of `error` across an orthonormal basis.
inline Vec3 across(Vec3 error, const std::vector<Vec3>& basis) {
  for (const Vec3& b : basis) error -= b * b.dot(error);
  return error;
}

/// Angle between two lines through one point [rad].
inline double axis_angle(const Vec3& a, const Vec3& b) {
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

/// The turn about the body's incoming axis that brings the found outgoing axis nearest to the true one.
inline double best_turn(const JointTruth& incoming, const JointTruth& outgoing, const JointEstimate& found) {
  const Vec3 n = incoming.axis_in_child;
  const auto flat = [&](const Vec3& v) { return Vec3(v - n * n.dot(v)); };
  Vec3 is = found.axis_in_parent, ought = outgoing.axis_in_parent;
  if (is.dot(ought) < 0.0) is = -is;
  if (flat(ought).norm() < 0.2) {
    is = found.point_in_parent - incoming.point_in_child;
    ought = outgoing.point_in_parent - incoming.point_in_child;
  }
  is = flat(is), ought = flat(ought);
  return std::atan2(n.dot(is.cross(ought)), is.dot(ought));
}

}  // namespace kinfer::study
