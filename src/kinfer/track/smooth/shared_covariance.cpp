// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/smooth/shared_covariance.hpp"

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::track {

SharedCovariance::SharedCovariance(const FilterModel& model)
    : value_(MatrixXd::Zero(model.layout.size, model.layout.size)) {}

void SharedCovariance::update(const ChainFilter& filter) {
  const FilterLayout& layout = filter.model().layout;
  const Index fast = layout.fast, slow = layout.size - fast;
  value_ = filter.covariance();
  const MatrixXd across = value_.bottomLeftCorner(slow, fast);
  const MatrixXd solved = solve_semidefinite(value_.bottomRightCorner(slow, slow), across);
  value_.topLeftCorner(fast, fast) = transposed_times(across, solved);
}

}  // namespace kinfer::track
