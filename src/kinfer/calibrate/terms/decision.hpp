// SPDX-License-Identifier: Apache-2.0
// Whether a model term is accepted, from the held-out errors without and with it.
//
// A term is accepted when the mean held-out error falls significantly, the largest held-out error does not rise, and
// the model does not extrapolate worse. Training errors always fall and are not a criterion.
#pragma once

#include <span>

#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::calibrate {

/// Paired comparison of held-out errors [m], one entry per measurement; zero for fewer than two.
ErrorChange compare_errors(std::span<const double> before, std::span<const double> after);

/// Whether the interpolation errors speak for the term: accepted, no_improvement, not_significant or worst_error_rises.
/// `geometry_worst`: largest held-out error of the geometric model [m].
Decision decide_by_interpolation(const ErrorChange& interpolation, double geometry_worst);

/// The decision by both comparisons. An extrapolation that was not tested (mean_before 0) does not count against a
/// term.
Decision decide(const ErrorChange& interpolation, const ErrorChange& extrapolation, double geometry_worst);

}  // namespace kinfer::calibrate
