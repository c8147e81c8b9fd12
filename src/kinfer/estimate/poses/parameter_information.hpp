// SPDX-License-Identifier: Apache-2.0
// What the measurements alone say about the joint parameters, and how well a prior foretells it.
#pragma once

#include <optional>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/fleet/task_summary.hpp"

namespace kinfer {

/// The likelihood of the joint parameters that a data sheet states: the inverse of their block of the covariance, minus
/// the information of the prior. None where there are none, or their covariance is singular.
std::optional<ParameterInformation> information_of(const Estimate& estimate, const NominalModel& model);

/// Without the directions that the data know worse than to ten tolerances. Their small information is the difference of
/// large numbers, so that its errors could claim anything about them.
ParameterInformation without_weak_directions(ParameterInformation data);

/// Logarithm of the likelihood of the data where u is a draw of N(mean, covariance), u = (x − nominal) / tolerance, up
/// to a constant of the data: −½ log |I + Σ Λ| + ½ gᵀ (Λ + Σ⁻¹)⁻¹ g + hᵀ m − ½ mᵀ Λ m with g = h − Λ m. None where the
/// covariance is not positive definite.
std::optional<double> log_marginal_likelihood(const ParameterInformation& data, ConstVectorRef mean,
                                              ConstMatrixRef covariance);

}  // namespace kinfer
