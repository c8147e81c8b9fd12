// SPDX-License-Identifier: Apache-2.0
// Compiles a chain and the set of its identified parameters into the plain structs of the batch kernels.
#pragma once

#include <span>
#include <vector>

#include "kinfer/kinematics/batch/chain_segments.hpp"
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
/// deflection, backlash, harmonics, thermal expansion and displacement fields have no batch form.
bool has_batch_form(const Chain& chain, const ParameterSet& set);

}  // namespace kinfer

namespace kinfer::batch {

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

/// Group of a target (−1: the tool point), with no items yet; checks whether it lies on the last joint axis.
Group group_at(const SegmentList& list, const Chain& nominal, int target);

/// A chain with its identified parameters, as the kernels use it.
struct ChainPlan {
  std::vector<JointMotion> joint_motions;
  SegmentList list;
  ScrewPlan screws;  ///< only with BaseSide::chain
};
ChainPlan plan_of(const Chain& nominal, const ParameterSet& set, BaseSide side);

}  // namespace kinfer::batch
