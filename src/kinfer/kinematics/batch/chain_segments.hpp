// SPDX-License-Identifier: Apache-2.0
// The constant transforms between joint motions, as the kernels' segments, and the elementary motions as screws.
#pragma once

#include <vector>

#include "kinfer/kinematics/batch/parameter_lookup.hpp"

namespace kinfer::batch {

/// How a joint moves with the joint positions q, and which numbers of an item belong to it.
struct JointMotion {
  int joint = 0;
  MotionKind move = MotionKind::revolute;
  int slot = 0;
  Value gain;
  int q_index = -1;                   ///< index into q; −1: none
  std::vector<Coupling> couplings{};  ///< Coupling::joint is an index into q

  int slots() const { return move == MotionKind::revolute ? 2 : move == MotionKind::prismatic ? 1 : 3; }
};

/// On which side of the error a base that is not identified is applied.
enum class BaseSide {
  chain,        ///< to the chain, with the other constant transforms
  measurement,  ///< to the measured points: errors are in the base frame, of the same norm
};

/// Segments from the base to the tool. A general segment's factors are in `factors`.
struct SegmentList {
  std::vector<Segment> segments;
  std::vector<std::vector<Factor>> factors;
  Pose base;                      ///< frame in which the measured points are to be expressed
  VectorXd nominal;               ///< of the free parameters
  std::vector<int> angles;        ///< those of them that are angles, indexed by Value::angle
  std::vector<LinkSheet> sheets;  ///< empty: no segment is in one
  bool is_all_in_sheets = true;   ///< all segments that vary
};

/// Screws from the world to the tool.
struct ScrewPlan {
  std::vector<Screw> screws;
  std::vector<int> idle;  ///< parameters whose columns no screw writes
};

/// One segment before each joint motion, and one behind the last.
SegmentList segments_of(const Chain& nominal, const ParameterSet& set, const ParameterLookup& lookup,
                        const std::vector<JointMotion>& joint_motions, BaseSide side);

/// The chain from the base to the tool as screws, for derivatives.
ScrewPlan screws_of(const Chain& nominal, const ParameterSet& set, const ParameterLookup& lookup,
                    const std::vector<JointMotion>& joint_motions);

}  // namespace kinfer::batch
