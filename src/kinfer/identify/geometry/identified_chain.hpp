// SPDX-License-Identifier: Apache-2.0
// Products of an identification, made from the estimated joints: canonical DH rows, link lengths, a chain.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/geometry/joint_precision.hpp"

namespace kinfer::identify {

/// Geometry of a joint and its precision, as needed to make its DH rows.
struct GeometryEstimate {
  JointGeometry geometry;
  JointPrecision precision;
};

JointEstimate joint_estimate(const std::string& parent, const std::string& child, const GeometryEstimate& estimate);

/// One row per leaf; its variables are named after the signals.
std::vector<DhRowEstimate> leaf_dh_rows(const std::string& segment, std::span<const DhLeaf> leaves,
                                        std::span<const JointSignal> signals);

/// Successive axes that a joint rotates about or translates along; unit, in the parent at joint position 0. A rigid
/// joint has one axis without a joint variable.
std::vector<Vec3> joint_axes(EstimatedJointType type, const JointGeometry& geometry);

/// DH rows of a joint, by dh_rows_through its axes.
std::vector<DhNumbers> joint_dh_rows(EstimatedJointType type, const JointGeometry& geometry);

/// The joint's rows with standard deviations. Its variable is named "parent-child"; several are "parent-child 1", ...
std::vector<DhRowEstimate> canonical_dh_rows(const JointEstimate& joint, const GeometryEstimate& estimate);

/// From the root's sensor: for each joint a fixed row to its first axis, a moving row for each axis, and a fixed row to
/// the child's sensor, named after it. `dh`: canonical_dh_rows of all joints in their order. `world_R_root`:
/// orientation of the root's sensor in the world at the start.
Chain build_chain(const std::string& root, const std::vector<JointEstimate>& joints,
                  const std::vector<DhRowEstimate>& dh, const Mat3& world_R_root);

/// Adds the joints that close loops, between the frames of their sensors. `chain`: of build_chain.
void set_closures(Chain& chain, const std::string& root, const std::vector<LoopEstimate>& loops);

/// Sets the chain's tool to the point named "tip" or "tool", or to the only point; all others are ignored.
void set_tool(Chain& chain, const std::vector<PointEstimate>& places);

}  // namespace kinfer::identify
