// SPDX-License-Identifier: Apache-2.0
// The parameters of a chain and its displacement field together: one linear system, and how large the field is by the
// marginal likelihood.
//
// With K the covariance of the inducing points and V diag(w) Vᵀ = K, each component of the field is
// k(q)ᵀ V w^−½ z with independent z ~ N(0, size²): near the optimum all measurements are linear in z and the
// parameters. These are eliminated under their own priors, which leaves an information S and an image b of z; as for a
// group of terms (relevance.hpp), but with the noise level v unknown too:
//   log p(data | f, v) − log p(data | 0, v) = ½ Σ_k [ f² b_k²/v² / (1 + f² s_k/v) − log(1 + f² s_k/v) ]
// with the eigenvalues s_k of S, and b along its eigenvectors.
#pragma once

#include "kinfer/calibrate/functions/beside_functions.hpp"

namespace kinfer::calibrate {

class FieldProblem {
 public:
  /// About `chain` and without its field, whose inducing points and lengths hold. Keeps references to the first two.
  FieldProblem(const Chain& chain, const ParameterSet& set, const WeightedRows& data);

  struct Evidence {
    double log_bayes_factor = 0.0;  ///< of a field against none, for all its sizes under a half-Cauchy prior
    double size = 0.0;              ///< [m] the most probable one
    double noise = 1.0;             ///< variance beside it, in units of the weights
  };
  /// `scale`: [m] of the prior of the size.
  Evidence evidence(double scale) const;

  /// Information and squared images of independent combinations of the values.
  struct Spectrum {
    VectorXd information, squared_image;
  };
  Spectrum spectrum() const;
  /// Log marginal likelihood of the data up to a constant, for a size [m] (0: no field) and a noise level.
  double log_evidence(const Spectrum& of, double size, double noise) const;

  struct Solution {
    VectorXd step;    ///< of the parameters
    VectorXd values;  ///< z of all three components, one after the other [m]
    double size = 0.0;
    /// Of the parameters, the field being as found: where both can explain the same, they move against each other, and
    /// the tool does not. What held-out residuals exceed it by is the model error.
    MatrixXd covariance;
    VectorXd marginal_variances;    ///< of the parameters, whatever the field is
    double effective_number = 0.0;  ///< of the values that the data determine
  };
  Solution solve(double size, double noise) const;

  /// The chain after a step, with the field.
  Chain moved_by(const Solution& solution) const;

  /// [1] by which a step lowers the rms of the residuals.
  double relative_gain(const Solution& solution) const;

 private:
  void linearise(const WeightedRows& data);
  void eliminate_parameters();
  VectorXd residuals_after(const VectorXd& step, const VectorXd& values) const;
  VectorXd present_values() const;

  const Chain& chain_;
  const ParameterSet& set_;
  FieldRoots roots_;    // of its inducing points
  VectorXd residuals_;  // without the field
  MatrixXd by_parameter_, by_value_;
  MatrixXd inverse_;      // of the parameters' information, priors included
  VectorXd gradient_;     // of the parameters, priors included
  MatrixXd explained_;    // what the parameters take of each value: parameters x values
  MatrixXd information_;  // S
  VectorXd image_;        // b
  double squares_ = 0.0;  // of residuals and priors, parameters at their optimum without a field
  double redundancy_ = 0.0;
};

}  // namespace kinfer::calibrate
