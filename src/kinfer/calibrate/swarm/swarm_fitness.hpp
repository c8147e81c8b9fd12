// SPDX-License-Identifier: Apache-2.0
// Paper 2, eq. (11), for many parameter vectors at once: F(x) = Σ_i |p_measured,i − f_i(x)|².
//
// Uses the batch kernels of kinematics; pose by pose where joints are compliant under gravity.
#pragma once

#include <memory>
#include <span>

#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

class SwarmFitness {
 public:
  /// `nominal` holds the parameters that are not free. Only measured points are used.
  SwarmFitness(const Chain& nominal, const ParameterSet& set, const PoseSet& data);
  ~SwarmFitness();
  SwarmFitness(SwarmFitness&&) noexcept;

  /// Sum of squared errors [m²] of each column of x (free parameters x n). Thread-safe.
  void sums(ConstMatrixRef x, std::span<double> sum) const;

  /// Number of points in the sum.
  std::size_t points() const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace kinfer::calibrate
