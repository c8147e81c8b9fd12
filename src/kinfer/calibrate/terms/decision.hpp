// SPDX-License-Identifier: Apache-2.0
// The proof of a model that the marginal likelihood chose: what the held-out errors say against it.
//
// A term is refused only where the mean, the 95 % or the 99 % point of the held-out errors is worse with it, and not by
// chance. Single poses decide nothing.
#pragma once

#include <span>

#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::calibrate {

/// Paired comparison of held-out errors [m], one entry per measurement; zero for fewer than two.
ErrorChange compare_errors(std::span<const double> before, std::span<const double> after);

/// accepted, no_improvement, tail_rises or extrapolation_worse. A comparison that was not made (mean_before 0) does not
/// count against a model.
Decision decide(const ErrorChange& interpolation, const ErrorChange& extrapolation);

}  // namespace kinfer::calibrate
