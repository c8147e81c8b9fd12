// SPDX-License-Identifier: Apache-2.0
// The identified parameters and their uncertainty.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/stop.hpp"
#include "kinfer/evidence/calibration/fit_errors.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// Why the data do not determine a combination of parameters.
enum class Undetermined {
  no_effect,              ///< the parameter has no effect on the measurements
  weaker_than_tolerance,  ///< the tolerance of the parameter says more than the data
  confounded,             ///< only a combination of these parameters is determined
};
std::string_view name(Undetermined reason);

struct UndeterminedGroup {
  Undetermined reason = Undetermined::confounded;
  std::vector<std::string> parameters;
};

/// Identifiability of the parameters, scaled by noise and tolerances: a singular value above 1 means that the data
/// determine this combination of parameters better than the tolerances do.
struct Identifiability {
  VectorXd singular_values;                     ///< descending, one per free parameter
  int rank = 0;                                 ///< number of singular values above 1
  std::vector<UndeterminedGroup> undetermined;  ///< one per singular value that is not above 1
};

struct ParameterEstimate {
  std::string name;
  Quantity quantity = Quantity::length;
  double nominal = 0.0, value = 0.0, sd = 0.0;
  bool identifiable = false;  ///< the data at least halve the prior variance
};

enum class SearchMethod { levenberg_marquardt, pso, qpso, bpnn_pso };
/// As of --method: "lm", "pso", "qpso", "bpnn-pso"
std::string_view name(SearchMethod method);
std::optional<SearchMethod> search_method(std::string_view name);

/// The initial swarm of a search.
enum class InitialSwarm {
  uniform,  ///< drawn uniformly from the box
  compact,  ///< about the nominal values
  warm,     ///< contains the earlier calibration
  network,  ///< predicted by the network of an earlier search
};
std::string_view name(InitialSwarm swarm);  ///< "cold", "nominal swarm", "warm start", "net"

/// One of several searches on the same problem, for comparison.
struct SearchRun {
  InitialSwarm initial = InitialSwarm::uniform;
  int iterations = -1;  ///< until the target was reached; -1: not within the budget
  int evaluations = 0;
  double rms = 0.0;  ///< [m] final error of the points
};

/// The optimisation that found the parameters.
struct SearchSummary {
  SearchMethod method = SearchMethod::levenberg_marquardt;
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
  /// The same, series being as found: where a parameter and a series explain the same, they move against each other,
  /// and the tool does not. Empty of a chain without series.
  MatrixXd covariance_beside_series;
  /// Derivatives of the series' coefficients, all knots of one series after those of the one before, by the free
  /// parameters where every series is at its best beside them; empty of a chain without series.
  MatrixXd series_response;
  Identifiability identifiability;
  std::optional<double>
      chi2_per_n;  ///< of the inlier measurements with the instrument's noise (1 is good); none: instrument unknown
  double sigma = 0.0, sigma_angle = 0.0;  ///< [m], [rad] noise used as weights: instrument's, or the residual level
  double sigma_pose = 0.0;                ///< [m] part of `sigma` that all measurements of a repeated pose share
  std::vector<Outlier> outliers;
  double negative_log_evidence =
      0.0;  ///< −2 log of the marginal likelihood (Laplace): compares models of the same rows
  double predicted_error =
      0.0;  ///< [m] rms tool error expected over the data's poses; of a calibration with model error
  SearchSummary search;
};

/// Of the free parameters, by what they move the tool: functions of joint positions being as found. What they leave
/// open is part of the model error.
inline const MatrixXd& covariance_of_predictions(const Estimate& estimate) {
  const MatrixXd& beside = estimate.covariance_beside_series;
  return beside.size() > 0 ? beside : estimate.covariance;
}

}  // namespace kinfer
