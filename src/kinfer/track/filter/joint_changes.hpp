// SPDX-License-Identifier: Apache-2.0
// A joint that no longer fits the chain: its play or bend shows in all sensors beyond it alike. A change δ of angular
// velocity and specific force of the first body beyond it (in that body's frame) reaches the sensors' rows as F δ, by
// the chain's own derivatives. With b = Fᵀ S⁻¹ν and A = Fᵀ S⁻¹ F (generalised likelihood ratio; Willsky and Jones 1976)
//
//   δ̂ = A⁻¹ b with covariance A⁻¹,  T = bᵀ A⁻¹ b, whose expectation is 6 where the joint fits.
//
// A joint in doubt has a change of its own in every update, N(0, Q) with Q = D A⁻¹ D, D² being how far δ̂ exceeds its
// covariance, for angular velocity and force apart: what still fits of it is used.
#pragma once

#include "kinfer/linalg/block_products.hpp"
#include "kinfer/track/model/chain_measurement.hpp"

namespace kinfer::track {

class JointChanges {
 public:
  explicit JointChanges(const FilterModel& model);

  /// F of every joint that can be told from a sensor: two sensors or more on both sides are measured, of each both
  /// triples of rows (`is_measured`: of each triple). A base that is still stands for a sensor before all joints.
  void form(const FilterModel& model, const ChainEvaluator& evaluator, const std::vector<bool>& is_measured,
            bool is_base_still);

  /// The joints in doubt, from S = L Lᵀ without their changes, or the others: `inverse` is L⁻¹ and `whitened` L⁻¹ν.
  void examine(ConstMatrixRef inverse, ConstVectorRef whitened, bool are_doubted);

  /// Adds F Q Fᵀ to the lower half of S for every joint in doubt; after `examine`.
  void widen(MatrixRef s) const;

  void doubt(std::size_t joint, bool is_doubted);
  bool is_doubted(std::size_t joint) const { return joints_[joint].is_doubted; }
  bool doubts_any() const;

  std::size_t size() const { return joints_.size(); }
  bool is_told(std::size_t joint) const { return joints_[joint].is_told; }
  double distance(std::size_t joint) const { return joints_[joint].distance; }  ///< T

 private:
  struct Joint {
    bool is_doubted = false, is_told = false;
    double distance = 0.0;
    double rate = 0.0, force = 0.0;  // D²
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    MatrixXd rows;  // F
  };

  std::vector<Joint> joints_;
  std::vector<Eigen::Matrix<double, 9, 6>> by_change_;  // of each body
  MatrixXd whitened_rows_;                              // L⁻¹ F
};

}  // namespace kinfer::track
