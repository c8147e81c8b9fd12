// A first guess of every joint of the tree, from pairs of neighbours alone: good enough for the continuous-time fit to
// find its way.
#pragma once

#include "kinfer/estimate/ins_chain.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

struct JointStart {
  std::size_t parent = 0, child = 0;  ///< segments
  FoundJointType type = FoundJointType::revolute;
  std::vector<InsBody> bodies{};                ///< behind each other; the last one carries the child's sensor
  std::vector<std::vector<double>> readings{};  ///< [rad] or [m] at the rows of the motion's clock, one a moving body
};

/// Axes by the relative rate, readings by the turn about them, points by the pair's fit.
JointStart joint_start(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent, std::size_t child,
                       FoundJointType type);

/// A rotation whose third column is the unit vector.
Mat3 frame_along(const Vec3& axis);

}  // namespace kinfer
