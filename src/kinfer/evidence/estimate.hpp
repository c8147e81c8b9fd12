// What was identified and how far to trust it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/stop.hpp"
#include "kinfer/evidence/fit.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// What the data can tell about the parameters, in units of the noise and of the tolerances: a singular value above 1
/// means that the data know this combination better than the tolerances do.
struct Identifiability {
  VectorXd singular_values;             ///< descending, one a free parameter
  int rank = 0;                         ///< number of singular values above 1
  std::vector<std::string> confounded;  ///< in words: "d2 and d3 cannot be told apart from these poses"
};

struct ParameterEstimate {
  std::string name;
  Quantity quantity = Quantity::length;
  double nominal = 0.0, value = 0.0, sd = 0.0;
  bool identifiable = false;  ///< the data halve the variance that the tolerance allows
};

/// One of several searches on the same problem, to compare them.
struct SearchRun {
  std::string name;     ///< "cold", "nominal swarm", "warm start", "net"
  int iterations = -1;  ///< until the target was reached; -1: not within the budget
  int evaluations = 0;
  double rms = 0.0;  ///< [m] error of the points at the end
};

/// How the numbers were found.
struct Search {
  std::string method;  ///< "lm"
  int iterations = 0, evaluations = 0;
  Stop stop = Stop::converged_cost;
  double cost = 0.0;                    ///< final
  std::vector<double> best;             ///< cost after each iteration
  std::vector<double> median;           ///< of the population, where there is one
  std::string net;                      ///< BPNN-PSO: the trained net as text, for the next calibration of this robot
  std::vector<SearchRun> side_by_side;  ///< what a net is worth (BPNN-PSO only)
};

struct Estimate {
  Chain chain;
  ParameterSet parameters;
  std::vector<ParameterEstimate> values;  ///< of the free parameters, in order
  MatrixXd covariance;                    ///< of the free parameters, SI, inflated where the model misfits
  Identifiability identifiability;
  std::optional<double>
      chi2_per_n;  ///< of the believed measurements against the instrument (1 is good); none: no instrument known
  double sigma = 0.0, sigma_angle = 0.0;  ///< [m], [rad] that weighted the measurements: instrument, or residual level
  std::vector<Outlier> outliers;
  double surprise = 0.0;         ///< −2 log of the marginal likelihood (Laplace): compares models of the same rows
  double predicted_error = 0.0;  ///< [m] rms error of the tool over the data's poses that the covariance expects
  Search search;
};

}  // namespace kinfer
