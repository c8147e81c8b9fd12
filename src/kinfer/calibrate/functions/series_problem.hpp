// SPDX-License-Identifier: Apache-2.0
// The parameters of a chain and the coefficients of its series together, as a Gaussian process: sizes and noise level
// that maximise the marginal likelihood (MacKay 1992), its value, and one linear step.
#pragma once

#include <vector>

#include "kinfer/calibrate/functions/series_equations.hpp"

namespace kinfer::calibrate {

class SeriesProblem {
 public:
  /// Starts with the sizes that the coefficients have. Keeps a reference to `apart`.
  SeriesProblem(const DetachedSeries& apart, const WeightedRows& data);

  struct Solution {
    VectorXd step;        ///< of the parameters, and the coefficients
    MatrixXd covariance;  ///< of both
    double noise = 1.0;   ///< variance in units of the weights
  };

  /// The noise level and the variances that maximise the marginal likelihood, from the present ones on.
  Solution maximise(int rounds);

  /// Log marginal likelihood up to a constant of the data.
  double log_evidence(const Solution& s) const;

  /// Log Bayes factor of a series against none, for all sizes. At the best size it is the density of the coefficients
  /// at zero, after over before (Savage, Dickey); log size has a half-Cauchy prior with the size of other harmonics,
  /// and is known to 1 / √(2 effective number).
  double log_bayes_factor(const Solution& s, std::size_t series) const;

  struct Step {
    VectorXd step;                      ///< as in a solution
    MatrixXd covariance;                ///< of the parameters alone, the series being unknown
    MatrixXd covariance_beside_series;  ///< the series being as found
    MatrixXd response;  ///< derivatives of all knots of the series by the parameters, the series at their best
  };

  /// The solution at noise 1 by elimination of the series, whose own covariance takes a multiple of the time.
  Step step() const;

  /// [1] of the rms of the residuals by which a step lowers it.
  double relative_gain(const VectorXd& step) const;

  /// The chain and its series after a step.
  DetachedSeries moved_by(const VectorXd& step) const;

 private:
  /// Of the coefficients of each series.
  void set_variances(std::vector<double> variance);
  /// Of the knots that rows reach.
  std::vector<double> present_variances() const;
  Solution solve(double noise) const;
  /// One row a knot from one row an unknown coefficient; zero where no row reaches the knot.
  MatrixXd of_all_knots(const MatrixXd& of_unknowns) const;
  VectorXd coefficients(const Solution& s, std::size_t series) const;
  /// The step that changes nothing: a step goes to coefficients, not by them.
  VectorXd present() const;
  double residual_squares(const VectorXd& step) const;
  /// Number of unknowns that the data determine; of all, and of one series.
  double effective_number(const Solution& s) const;
  double effective_number(const Solution& s, std::size_t series) const;

  const DetachedSeries& apart_;
  SeriesSystem system_;
  Eigen::Index parameters_;
  MatrixXd prior_;
  VectorXd pull_, offset_;
  std::vector<double> variance_;
};

}  // namespace kinfer::calibrate
