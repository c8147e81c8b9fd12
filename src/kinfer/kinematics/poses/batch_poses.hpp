// SPDX-License-Identifier: Apache-2.0
// Poses of the tool at many rows, and their derivatives by the free parameters, one row per lane: for chains of any
// form, with loads. PoseEvaluator is the same one pose at a time, and the judge of this.
#pragma once

#include <memory>
#include <span>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/kinematics/batch/kernel_interface.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {

/// What moves and loads the chain at one row, and where its results go.
struct PoseRow {
  const double* q = nullptr;  ///< dof, [rad] or [m]
  Load load{};                ///< gravity torques: those of all rows are given, or none
  Pose* pose = nullptr;       ///< world_T_tool
  Twists* twists = nullptr;   ///< its derivative (resized to 6 x free_count); none of the rows: poses only
};

class BatchPoses {
 public:
  /// Columns of the derivative follow the free parameters of `set`, as those of PoseEvaluator.
  BatchPoses(const Chain& chain, const ParameterSet& set, const batch::Kernels& kernels = batch::best_kernels());
  ~BatchPoses();
  BatchPoses(BatchPoses&&) noexcept;

  /// A buffer for the hot loop, one per thread.
  using Scratch = batch::AlignedBuffer<double>;

  void evaluate(std::span<const PoseRow> rows, Scratch& scratch) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace kinfer
