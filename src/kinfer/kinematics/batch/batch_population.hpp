// SPDX-License-Identifier: Apache-2.0
// Sums of squared position errors of whole populations of parameter vectors, at the speed of the processor's
// multiply-adds: F(x) = Σ_i |measured_i − f_i(x)|² (paper 2, eq. 11). docs/development/performance.md explains the
// bound.
//
// The sines of the joint positions are computed once for all candidates, the parameters of a candidate are folded into
// one constant transform between two joints (11 numbers for a DH or MDH link), and the points are transformed from the
// tip to the base: 12 multiply-adds per joint, one candidate per lane.
#pragma once

#include <memory>

#include "kinfer/kinematics/batch/chain_plan.hpp"

namespace kinfer {

/// T is double, or float where errors of about 1e-7 of the robot's reach do not matter.
template <class T>
class BatchPopulation {
 public:
  /// `nominal` holds the numbers that are not free. Precondition: has_batch_form(nominal, set).
  BatchPopulation(const Chain& nominal, const ParameterSet& set, const PointTable& points,
                  const batch::Kernels& kernels = batch::best_kernels());
  ~BatchPopulation();
  BatchPopulation(BatchPopulation&&) noexcept;

  /// Sum [m²] of each column of x (free parameters x n). A candidate's sum does not depend on its neighbours. Safe from
  /// several threads at once.
  void sums(ConstMatrixRef x, std::span<double> sum) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

extern template class BatchPopulation<double>;
extern template class BatchPopulation<float>;

}  // namespace kinfer
