// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/tool_poses.hpp"

#include <algorithm>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/kinematics/poses/batch_poses.hpp"

namespace kinfer {
namespace {

constexpr Eigen::Index chunk = 512;  // poses of one work item, whose numbers fit into the second cache

void write_pose(const Pose& pose, double* matrix) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[4 * row + column] = pose.rotation(row, column);
    matrix[4 * row + 3] = pose.position[row];
  }
  matrix[12] = matrix[13] = matrix[14] = 0.0, matrix[15] = 1.0;
}

}  // namespace

void tool_poses(const Chain& chain, ConstMatrixRef q, std::span<double> poses, int threads) {
  KINFER_EXPECT(q.rows() == dof(chain) && static_cast<Eigen::Index>(poses.size()) == 16 * q.cols(),
                "{} x {} joint positions, {} numbers", q.rows(), q.cols(), poses.size());
  const BatchPoses batch(chain, {});
  const Eigen::Index items = (q.cols() + chunk - 1) / chunk;
  parallel_for(static_cast<std::size_t>(items), threads, [&](std::size_t item) {
    const Eigen::Index begin = static_cast<Eigen::Index>(item) * chunk, size = std::min(chunk, q.cols() - begin);
    std::vector<Pose> at(static_cast<std::size_t>(size));
    std::vector<PoseRow> rows;
    for (Eigen::Index i = 0; i < size; ++i)
      rows.push_back({.q = q.col(begin + i).data(), .pose = &at[static_cast<std::size_t>(i)]});
    BatchPoses::Scratch scratch;
    batch.evaluate(rows, scratch);
    for (Eigen::Index i = 0; i < size; ++i)
      write_pose(at[static_cast<std::size_t>(i)], poses.data() + 16 * (begin + i));
  });
}

}  // namespace kinfer
