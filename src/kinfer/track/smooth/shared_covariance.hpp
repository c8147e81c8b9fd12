// SPDX-License-Identifier: Apache-2.0
// The part of a filter's covariance that stems from what changes slowly or not at all: geometry, zeros and the sensors'
// errors. Two filters on the same recording that begin with the same knowledge of them have this part in common.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

/// P with C = P_xs P_ss⁻¹ P_sx in the place of P_xx; x: the fast states, s: those of sensors and geometry.
class SharedCovariance {
 public:
  explicit SharedCovariance(const FilterModel& model);

  void update(const ChainFilter& filter);

  const MatrixXd& value() const { return value_; }

 private:
  MatrixXd value_;
};

}  // namespace kinfer::track
