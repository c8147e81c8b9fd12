// What a found chain says about its joint: the axis line in both sensors' frames, and the chain's canonical form.
#pragma once

#include <array>

#include "kinfer/identify/link_motion.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// A hinge between a parent's and a child's sensor. The two points are the same physical one, the point of the axis
/// that is nearest to the child sensor's origin; both axes have the sense of the positive angle.
struct HingeGeometry {
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();  ///< [m]
  Pose home;                                                           ///< parent_T_child at angle 0
  Mat3 ball_axes = Mat3::Identity();  ///< of a ball: columns, in the parent at home, that it turns about one by one
};

/// The common axis of the poses that the leaves make at the given signal values, by least squares; exact where the
/// leaves are a hinge. `signals` have at least 3 rows that differ.
HingeGeometry hinge_geometry(std::span<const DhLeaf> leaves, const std::vector<SignalRow>& signals);

/// parent_T_child of the hinge turned by `angle` [rad].
Pose turned(const HingeGeometry& hinge, double angle);

/// RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta)
Pose transform(const DhNumbers& row);

/// The row behind which z lies along a line: `direction` is unit. Where the line is nearly parallel to z, d would be
/// huge and ill-defined; then d is 0 and Hayati's angle beta takes its place.
DhNumbers row_to_line(const Vec3& point, const Vec3& direction);

/// The rows of a joint that turns about, or slides along, one axis after another, all through `point`: a row from the
/// parent to the first axis, one from each axis to the next and from the last one to the child's z, to whose theta or d
/// the axis' reading is added; theta and d along the child's z. `axes`: unit, in the parent at home.
std::vector<DhNumbers> rows_through(const Vec3& point, std::span<const Vec3> axes, const Pose& home);

/// The ten numbers of a hinge between two frames as canonical DH: a row from the parent to the axis; one from the axis
/// to the child's z, to whose theta the joint's angle is added; theta and d along that.
std::array<DhNumbers, 3> canonical_rows(const HingeGeometry& hinge);

/// The same product with fewer leaves, where neighbours can be merged exactly: numbers that are 0 let the ones beside
/// them add up (paper 1, table 5 to table 6).
std::vector<DhLeaf> merged(std::vector<DhLeaf> leaves);

}  // namespace kinfer
