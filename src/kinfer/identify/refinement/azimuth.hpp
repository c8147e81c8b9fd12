// SPDX-License-Identifier: Apache-2.0
// Uncertainty of a body's azimuth about the fixed axis it rotates about: the accelerometer determines the position of
// the axis, but rotating the whole sub-tree behind the body about that axis changes no signal.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer::identify {

/// [rad] Standard deviation of the azimuth, about the axis of `body`'s revolute joint, of the sub-tree behind the body.
/// Taken from the child joint whose axis is farthest from parallel, or from its point if all axes are parallel. 0 if
/// the body has no child.
double azimuth_sd(const InsLayout& layout, const InsBodies& bodies, ConstMatrixRef covariance, std::size_t body);

}  // namespace kinfer::identify
