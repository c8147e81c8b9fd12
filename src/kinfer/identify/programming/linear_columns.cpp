// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/linear_columns.hpp"

namespace kinfer::identify {

double dot(const Lanes3& a, const Lanes3& b, const Lane& weight) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) sum += weight[i] * a[c][i] * b[c][i];
  return sum;
}

Lanes3 difference(const Lanes3& a, const Lanes3& b) {
  Lanes3 result;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) result[c][i] = a[c][i] - b[c][i];
  return result;
}

std::vector<Lanes3> linear_columns(const LinkBlock& block, const std::vector<DhLeaf>& leaves, FrameLanes& frame) {
  std::vector<Lanes3> columns(2 * leaves.size() + static_cast<std::size_t>(bias_count));
  frame = block.parent;
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    block.rotate_theta(frame, leaves[l]);
    lever_arm_column(frame, 2, columns[2 * l]);
    lever_arm_column(frame, 0, columns[2 * l + 1]);
    block.rotate_alpha(frame, leaves[l]);
  }
  for (std::size_t k = 0; k < 3; ++k) {  // measured = true + R b: the prediction contains the parent's bias
    Lanes3& of_parent = columns[2 * leaves.size() + k];
    of_parent = block.parent.axes[k];
    for (Lane& lane : of_parent)
      for (double& value : lane) value = -value;
    columns[2 * leaves.size() + 3 + k] = block.axes[k];
  }
  return columns;
}

}  // namespace kinfer::identify
