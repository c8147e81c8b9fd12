// Errors of many measured points at one parameter vector, their derivative, and the normal equations of their least
// squares, one point a lane. No Jacobian is kept where only the normal equations are wanted.
#pragma once

#include <memory>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/kinematics/batch_plan.hpp"

namespace kinfer {

class BatchPoints {
 public:
  /// `nominal` holds the numbers that are not free. Programmer's error where has_batch_form is false.
  BatchPoints(const Chain& nominal, const ParameterSet& set, const PointTable& points,
              const batch::Kernels& kernels = batch::best_kernels());
  ~BatchPoints();
  BatchPoints(BatchPoints&&) noexcept;

  Eigen::Index points() const;
  Eigen::Index unknowns() const;

  /// 1 / standard deviation of each coordinate (3 x points) in the kernels' order.
  using Weights = batch::Buffer<double>;
  Weights weights(const Eigen::Matrix3Xd& inverse_sd) const;

  /// A buffer for the hot loop, one a thread.
  using Scratch = batch::Buffer<double>;

  /// measured − predicted at x [m], 3 x points.
  void errors(ConstVectorRef x, Eigen::Matrix3Xd& error, Scratch& scratch) const;

  /// Σ |weight · (measured − predicted)|² at x.
  double cost(ConstVectorRef x, const Weights& weights, Scratch& scratch) const;

  /// The errors as the kernels leave them: 3 x lanes a block, in the order of `Weights`. Valid until `scratch` is used
  /// again.
  const double* lane_errors(ConstVectorRef x, Scratch& scratch) const;

  /// Weighted residuals r (3 a point, in the points' order) and J = dr/dx, 3 points x unknowns.
  void residuals(ConstVectorRef x, const Weights& weights, VectorRef r, Eigen::Ref<MatrixXd> jacobian,
                 Scratch& scratch) const;

  /// The same as the kernels leave it: residuals, then column by column, each 3 x lanes a block. Valid until `scratch`
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
