// SPDX-License-Identifier: Apache-2.0
// Compiles a chain and the set of its identified parameters into the plain structs of the batch kernels.
#pragma once

#include <span>
#include <vector>

#include "kinfer/kinematics/batch/kernel_interface.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// Measured points, each at its own joint positions.
struct PointTable {
  MatrixXd joints;            ///< dof x points
  Eigen::Matrix3Xd measured;  ///< [m], in the world
  std::vector<int> target{};  ///< one per point, index into Chain::targets, −1: the tool point; empty: all −1
};

/// True if each joint displacement is gain · joint position + couplings, and only geometry and gains are identified:
/// deflection, backlash, harmonics and thermal expansion have no batch form.
bool has_batch_form(const Chain& chain, const ParameterSet& set);

}  // namespace kinfer

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

/// Number of slots of all joint motions. The motions are listed from the base on, the slots from the tip on.
int slots_of(const std::vector<JointMotion>& joint_motions);

/// The numbers of the items, one item per row: the slots of the joint motions, then the measured point.
MatrixXd items_of(const std::vector<JointMotion>& joint_motions, const PointTable& points, const Pose& measured_from,
                  const Kernels& kernels);

/// Indices of the measured points of each target that has any: the tool point (−1) first.
struct PointsAtTarget {
  int target = -1;
  std::vector<int> points{};
};
std::vector<PointsAtTarget> points_by_target(const Chain& chain, const PointTable& points);

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

/// Group of a target (−1: the tool point), with no items yet; checks whether it lies on the last joint axis.
Group group_at(const SegmentList& list, const Chain& nominal, int target);

/// Screws from the world to the tool.
struct ScrewPlan {
  std::vector<Screw> screws;
  std::vector<int> idle;  ///< parameters whose columns no screw writes
};

/// A chain with its identified parameters, as the kernels use it.
struct ChainPlan {
  std::vector<JointMotion> joint_motions;
  SegmentList list;
  ScrewPlan screws;  ///< only with BaseSide::chain
};
ChainPlan plan_of(const Chain& nominal, const ParameterSet& set, BaseSide side);

}  // namespace kinfer::batch
