// SPDX-License-Identifier: Apache-2.0
// Moments of a recording in which the machine moves faster than splines can follow: jerks at the begin and end of
// motions, of a machine whose other motions the knots do represent.
#pragma once

#include <array>

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

/// Of each interval of `grid`: variance of the gyroscope's and of the accelerometer's measurements about splines of
/// their own, over that of their noise; at least 1, and 1 where that is no more than chance. The knots of those
/// splines are wider than `grid`'s by √2, as finer ones were chosen by it (knot_spacing): an acceleration is the second
/// derivative of a joint's spline, which follows less than a spline of the acceleration itself. Of an instrument that
/// such splines do not follow at all, all are 1.
std::array<std::vector<double>, 2> unfollowed_variances(const InsSensor& sensor, std::span<const double> time,
                                                        const SplineGrid& grid, const InsNoise& noise);

/// Raises the variance of a sensor's measurements where its motion is not followed: their residuals are no noise, and
/// as large as the accelerations from which the lever arms are told.
void discount_fast_motion(InsMeasurements& measured, const InsSensor& sensor, std::span<const double> time,
                          const SplineGrid& grid);

/// Whether any measurement of the problem is discounted; and the problem with all of them at their full weight.
bool discounts_fast_motion(const InsProblem& problem);
void count_fast_motion(InsProblem& problem);

}  // namespace kinfer
