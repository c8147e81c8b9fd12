// SPDX-License-Identifier: Apache-2.0
// Unknowns after a step of the fit (retraction on a manifold: Absil, Mahony, Sepulchre 2008, section 4.1).
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// Rotations are multiplied, all else is added. What a step contains of an azimuth (azimuth.hpp) rotates the sub-tree
/// about the axis by that angle, however large: where nothing tells the azimuth, the cost stays as it is.
InsUnknowns retract(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsStep& step);

}  // namespace kinfer
