// A first guess of every joint of the tree, from pairs of neighbours alone: good enough for the continuous-time fit to
// find its way.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

struct JointStart {
  std::size_t parent = 0, child = 0;  ///< segments
  FoundJointType type = FoundJointType::revolute;
  Mat3 parent_R_axis = Mat3::Identity(), child_R_axis = Mat3::Identity();  ///< z along the axis
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();      ///< [m]
  std::vector<double> reading{};  ///< [rad] or [m] at the rows of the motion's clock; empty for a rigid joint
};

/// Axis by the principal direction of the relative rate, reading by the twist about it, points by the pair's fit.
JointStart joint_start(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent, std::size_t child,
                       FoundJointType type);

/// A rotation whose third column is the unit vector.
Mat3 frame_along(const Vec3& axis);

}  // namespace kinfer
