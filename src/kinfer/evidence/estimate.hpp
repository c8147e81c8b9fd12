// SPDX-License-Identifier: Apache-2.0
// The identified parameters and their uncertainty.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/stop.hpp"
#include "kinfer/evidence/fit_errors.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// Identifiability of the parameters, scaled by noise and tolerances: a singular value above 1 means that the data
/// determine this combination of parameters better than the tolerances do.
struct Identifiability {
  VectorXd singular_values;             ///< descending, one per free parameter
  int rank = 0;                         ///< number of singular values above 1
  std::vector<std::string> confounded;  ///< groups of confounded parameters, one sentence each
};

struct ParameterEstimate {
  std::string name;
  Quantity quantity = Quantity::length;
  double nominal = 0.0, value = 0.0, sd = 0.0;
  bool identifiable = false;  ///< the data at least halve the prior variance
};

/// One of several searches on the same problem, for comparison.
struct SearchRun {
  std::string name;     ///< "cold", "nominal swarm", "warm start", "net"
  int iterations = -1;  ///< until the target was reached; -1: not within the budget
  int evaluations = 0;
  double rms = 0.0;  ///< [m] final error of the points
};

/// The optimisation that found the parameters.
struct SearchSummary {
  std::string method;  ///< "lm"
  int iterations = 0, evaluations = 0;
  Stop stop = Stop::converged_cost;
  double cost = 0.0;           ///< final
  std::vector<double> best;    ///< cost after each iteration
  std::vector<double> median;  ///< of the population, where there is one
  std::string net;             ///< BPNN-PSO: the trained network as text, for this robot's next calibration
  std::vector<SearchRun> swarm_comparison;  ///< the network compared with other initial swarms (BPNN-PSO only)
};

struct Estimate {
  Chain chain;
  ParameterSet parameters;
  std::vector<ParameterEstimate> values;  ///< of the free parameters, in order
  MatrixXd covariance;                    ///< of the free parameters, SI, inflated where the residuals exceed the noise
  Identifiability identifiability;
  std::optional<double>
      chi2_per_n;  ///< of the inlier measurements with the instrument's noise (1 is good); none: instrument unknown
  double sigma = 0.0, sigma_angle = 0.0;  ///< [m], [rad] noise used as weights: instrument's, or the residual level
  std::vector<Outlier> outliers;
  double negative_log_evidence =
      0.0;                       ///< −2 log of the marginal likelihood (Laplace): compares models of the same rows
  double predicted_error = 0.0;  ///< [m] rms tool error over the data's poses, predicted from the covariance
  SearchSummary search;
};

}  // namespace kinfer
