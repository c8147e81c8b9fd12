// SPDX-License-Identifier: Apache-2.0
// Errors of many measured points for one parameter vector, their Jacobian, and the normal equations of their least
// squares, one point per lane. The Jacobian is not stored where only the normal equations are needed.
#pragma once

#include <memory>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/kinematics/batch/chain_plan.hpp"

namespace kinfer {

class BatchPoints {
 public:
  /// `nominal` holds the numbers that are not free. Precondition: has_batch_form(nominal, set).
  BatchPoints(const Chain& nominal, const ParameterSet& set, const PointTable& points,
              const batch::Kernels& kernels = batch::best_kernels());
  ~BatchPoints();
  BatchPoints(BatchPoints&&) noexcept;

  Eigen::Index points() const;
  Eigen::Index unknowns() const;

  /// 1 / standard deviation of each coordinate (3 x points) in the kernels' order.
  using Weights = batch::AlignedBuffer<double>;
  Weights weights(const Eigen::Matrix3Xd& inverse_sd) const;

  /// A buffer for the hot loop, one per thread.
  using Scratch = batch::AlignedBuffer<double>;

  /// measured − predicted at x [m], 3 x points.
  void errors(ConstVectorRef x, Eigen::Matrix3Xd& error, Scratch& scratch) const;

  /// Σ |weight · (measured − predicted)|² at x.
  double cost(ConstVectorRef x, const Weights& weights, Scratch& scratch) const;

  /// The errors in the kernels' layout: 3 x lanes per block, in the order of `Weights`. Valid until `scratch` is used
  /// again.
  const double* lane_errors(ConstVectorRef x, Scratch& scratch) const;

  /// Weighted residuals r (3 per point, in the order of the points) and J = dr/dx, 3 points x unknowns.
  void residuals(ConstVectorRef x, const Weights& weights, VectorRef r, Eigen::Ref<MatrixXd> jacobian,
                 Scratch& scratch) const;

  /// The same in the kernels' layout: residuals, then column by column, each 3 x lanes per block. Valid until `scratch`
  /// is used again.
  const double* lane_jacobian(ConstVectorRef x, const Weights& weights, Scratch& scratch) const;

  /// Jᵀ J (lower half) and Jᵀ r of the weighted residuals; returns |r|².
  double normal_equations(ConstVectorRef x, const Weights& weights, MatrixXd& matrix, VectorXd& gradient,
                          Scratch& scratch) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace kinfer
