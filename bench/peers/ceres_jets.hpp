// SPDX-License-Identifier: Apache-2.0
// Ceres on paper 2's problem with automatic derivatives: the Jacobian of its Jets, and a whole fit.
#pragma once

#include <memory>

namespace kinfer::bench {

class JetPoints {
 public:
  /// joints 6 x n, measured 3 x n; residuals are (measured − predicted) · inverse_sd.
  JetPoints(const double* joints, const double* measured, int n, double inverse_sd);
  ~JetPoints();
  JetPoints(const JetPoints&) = delete;
  JetPoints& operator=(const JetPoints&) = delete;

  /// r: 3 n; jacobian: 3 n x 24, row by row. x: a, alpha, d, theta of six rows.
  void evaluate(const double* x, double* r, double* jacobian) const;

  /// Levenberg-Marquardt from x; returns Σ r². The problem is built anew, as it is for every data set.
  double fit(double* x) const;

 private:
  struct Costs;
  std::unique_ptr<Costs> costs_;
};

}  // namespace kinfer::bench
