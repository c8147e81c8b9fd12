// SPDX-License-Identifier: Apache-2.0
// The two axes of a universal joint: one fixed in each segment, e₁ in the parent and e₂ in the child, at a constant
// angle β between e₁ and R e₂, R: the relative rotations. Alternately each axis is the one that minimises
//   var(e₁ · R e₂) / sin² β,  the variance of the angle,
// with the other fixed: an eigenvector of the moments of R about its mean.
#pragma once

#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer::identify {

struct UniversalAxes {
  Vec3 in_parent = Vec3::UnitZ(), in_child = Vec3::UnitZ();
  double angle = 0.0, deviation = 0.0;  ///< [rad] between both: mean and sd
};

/// `rotations`: parent_R_child, not empty. `starts`: axes in the parent, one per column, of which the search begins at
/// each.
UniversalAxes universal_axes(const std::vector<Mat3>& rotations, const Mat3& starts);

}  // namespace kinfer::identify
