// SPDX-License-Identifier: Apache-2.0
// Which few causes explain the difference of two estimates of the same parameters: greedy choice by posterior odds.
//
// Without a cause the difference is d ~ N(0, s S) with S the sum of both covariances and s an unknown inflation. A
// cause h adds D_h u_h with u_h ~ N(0, V_h), so that d ~ N(0, s S + Σ D_h V_h D_hᵀ): marginal likelihoods in closed
// form, averaged over a few sizes of the change and inflations.
#pragma once

#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer::identify {

struct ChangeHypothesis {
  MatrixXd effect;             ///< D: change of the parameters by that of the cause
  Eigen::Index rotations = 0;  ///< the first columns are of rotations [rad], the others of shifts [m]
  double prior_probability = 0.01;
};

struct ChosenChange {
  std::size_t hypothesis = 0;
  double log_odds = 0.0;               ///< ln posterior odds against its absence, beside the others
  double angle = 0.0, distance = 0.0;  ///< [rad], [m] prior standard deviations of u that explain the difference best
};

/// Most certain first. `covariance`: S, positive definite.
std::vector<ChosenChange> choose_changes(ConstVectorRef difference, ConstMatrixRef covariance,
                                         const std::vector<ChangeHypothesis>& hypotheses);

/// Posterior of all u_h one after the other, with these prior standard deviations.
struct ChangeEstimate {
  VectorXd mean;
  MatrixXd covariance;
};
ChangeEstimate estimate_changes(ConstVectorRef difference, ConstMatrixRef covariance,
                                const std::vector<ChangeHypothesis>& hypotheses, double angle, double distance);

/// dᵀ (S + Σ D V Dᵀ)⁻¹ d
double squared_distance(ConstVectorRef difference, ConstMatrixRef covariance);

}  // namespace kinfer::identify
