// SPDX-License-Identifier: Apache-2.0
// The order of poses with little joint travel.
#pragma once

#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::plan {

/// Order of the columns with little joint travel, starting at the pose nearest to the middle of the ranges: nearest
/// neighbours, then 2-opt exchanges. The distance of two poses is the largest motion of a joint [rad] (1 m = 1 rad).
std::vector<int> order_by_travel(const Chain& chain, const MatrixXd& q);
double travel(const MatrixXd& q, const std::vector<int>& order);

}  // namespace kinfer::plan
