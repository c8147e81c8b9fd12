// SPDX-License-Identifier: Apache-2.0
// The equations of one update: rows of the sensors, then soft constraints, with residuals ν, noise R and derivatives H.
//
// With W = P Hᵀ, S = H W + R = L Lᵀ and Y = W L⁻ᵀ the update is x += Y L⁻¹ν, P −= Y Yᵀ. Nothing is allocated after
// construction.
#pragma once

#include <vector>

#include "kinfer/linalg/block_products.hpp"
#include "kinfer/track/model/chain_measurement.hpp"

namespace kinfer::track {

class UpdateSystem {
 public:
  explicit UpdateSystem(const FilterModel& model);

  static Index most_rows(const FilterModel& model);

  // ---- forming the rows ----
  /// The sensors' rows, with their derivatives; soft rows are dropped.
  void begin(const ChainMeasurement& measurement);
  /// Other derivatives of the sensors' rows; soft rows stay.
  void linearise_again(const ChainMeasurement& measurement);
  /// Three rows of an instrument; where it is not measured, they are rows that change nothing.
  void set_instrument(Index first, bool is_measured, const Vec3& residual, double variance);
  /// A soft row without derivatives. Returns its index.
  Index append(double residual, double variance);
  double& derivative(Index row, Index state) { return h_(row, state); }

  Index rows() const { return rows_; }
  double derivative(Index row, Index state) const { return h_(row, state); }
  double variance(Index row) const { return noise_[row]; }
  const std::vector<bool>& is_measured() const { return is_measured_; }  ///< of each instrument

  // ---- solving them ----
  /// W and S from the covariance P.
  void multiply(const ChainMeasurement& measurement, const MatrixXd& p);
  /// L, L⁻¹ and L⁻¹ν of S as it is now; false where S is not positive definite.
  bool factorise();
  /// An instrument that is far off is trusted so much less that it is at the limit: whether S was changed.
  bool limit_outliers();
  /// W becomes Y.
  void divide();
  /// x becomes x L⁻ᵀ.
  void whiten(const MatrixRef& x) const { solve_right(root_.topLeftCorner(rows_, rows_), x); }
  /// Subtracts what errors of the state (a row each) change of the prediction; rows that are not measured have none.
  void subtract_predicted(const ChainMeasurement& measurement, const MatrixXd& errors, MatrixRef from) const;

  auto covariance() { return s_.topLeftCorner(rows_, rows_); }           ///< S, lower half
  auto inverse() const { return inverse_.topLeftCorner(rows_, rows_); }  ///< L⁻¹
  auto whitened() const { return whitened_.head(rows_); }                ///< L⁻¹ν
  auto gain() const { return w_.leftCols(rows_); }                       ///< Y, after `divide`
  double log_root_determinant() const;                                   ///< log |L|

 private:
  template <class Visit>
  void for_each_own_state(const ChainMeasurement& measurement, std::size_t sensor, const Visit& visit) const;
  void multiply_covariance(const ChainMeasurement& measurement, const MatrixXd& p);  // W
  void multiply_derivatives(const ChainMeasurement& measurement);                    // S
  void invert();

  FilterLayout layout_;
  Index rows_ = 0;
  VectorXd residual_, noise_, whitened_;
  MatrixXd h_, w_, s_, root_, inverse_;
  std::vector<bool> is_measured_;
};

}  // namespace kinfer::track
