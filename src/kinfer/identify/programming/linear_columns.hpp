// SPDX-License-Identifier: Apache-2.0
// Columns of the linear unknowns of a chain, in lanes of a block of rows.
#pragma once

#include <vector>

#include "kinfer/identify/programming/link_block.hpp"

namespace kinfer::identify {

inline constexpr Eigen::Index bias_count = 6;  // parent's accelerometer, then the child's

/// Weighted scalar product.
double dot(const Lanes3& a, const Lanes3& b, const Lane& weight);

/// a − b
Lanes3 difference(const Lanes3& a, const Lanes3& b);

/// Accelerations by each linear unknown: d and a of each leaf, then the biases. `frame` becomes the state after the
/// leaves.
std::vector<Lanes3> linear_columns(const LinkBlock& block, const std::vector<DhLeaf>& leaves, FrameLanes& frame);

}  // namespace kinfer::identify
