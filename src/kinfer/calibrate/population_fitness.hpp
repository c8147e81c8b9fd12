// Paper 2, eq. (11), for whole populations of parameter vectors: F(x) = Σ_i |p_measured,i − f_i(x)|².
//
// By the batch kernels of kinematics; where joints yield to gravity, pose by pose.
#pragma once

#include <memory>
#include <span>

#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

class PopulationFitness {
 public:
  /// `nominal` holds the numbers that are not free. Only the set's measured points count.
  PopulationFitness(const Chain& nominal, const ParameterSet& set, const PoseSet& data);
  ~PopulationFitness();
  PopulationFitness(PopulationFitness&&) noexcept;

  /// Sum of squared errors [m²] of each column of x (free parameters x n). Safe from several threads at once.
  void sums(ConstMatrixRef x, std::span<double> sum) const;

  /// Number of points in the sum.
  std::size_t points() const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace kinfer
