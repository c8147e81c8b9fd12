// SPDX-License-Identifier: Apache-2.0
// Joint geometry of an identified chain: the axis line in both sensor frames, and the chain's canonical DH form.
#pragma once

#include <array>

#include "kinfer/identify/programming/frame_state.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer::identify {

/// A joint axis between a parent's and a child's sensor. Both points are the same physical point, the point of the axis
/// nearest to the child sensor's origin; both axes have the sense of the positive joint angle.
struct JointGeometry {
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();  ///< [m]
  Pose home;                                                           ///< parent_T_child at angle 0
  Mat3 spherical_axes = Mat3::Identity();  ///< of a spherical joint: successive rotation axes, in the parent at home
};

/// The common rotation axis of the leaves' poses at the given signal values, by least squares; exact where the leaves
/// form a revolute joint. `signals`: at least 3 different rows.
JointGeometry fit_revolute_geometry(std::span<const DhLeaf> leaves, const std::vector<SignalRow>& signals);

/// parent_T_child at the joint angle `angle` [rad].
Pose pose_at(const JointGeometry& revolute, double angle);

/// RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta)
Pose transform(const DhNumbers& row);

/// The DH row that brings z onto a line; `direction` is unit. Where the line is nearly parallel to z, d would be huge
/// and ill-conditioned; then d is 0 and Hayati's angle beta replaces it.
DhNumbers dh_row_to_line(const Vec3& point, const Vec3& direction);

/// DH rows of a joint that rotates about, or translates along, successive axes through `point`: one row from the parent
/// to the first axis, one from each axis to the next and from the last one to the child's z, to whose theta or d the
/// joint position is added; then theta and d along the child's z. `axes`: unit, in the parent at home.
std::vector<DhNumbers> dh_rows_through(const Vec3& point, std::span<const Vec3> axes, const Pose& home);

/// The ten parameters of a revolute joint between two frames as canonical DH: one row from the parent to the axis; one
/// from the axis to the child's z, to whose theta the joint angle is added; theta and d along the child's z.
std::array<DhNumbers, 3> canonical_dh_rows(const JointGeometry& revolute);

/// The same product with fewer leaves, where adjacent ones can be merged exactly: parameters that are 0 allow the ones
/// beside them to be added (paper 1, table 5 to table 6).
std::vector<DhLeaf> merge_leaves(std::vector<DhLeaf> leaves);

}  // namespace kinfer::identify
