#include "kinfer/identify/joint_start.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/inertial/joint_signals.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

Mat3 relative_rotation(const SegmentMotion& parent, const SegmentMotion& child, std::size_t row) {
  return parent.rotation[row].transpose() * child.rotation[row];
}

/// Principal direction of the relative rates, in the parent.
Vec3 turning_axis(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  Mat3 spread = Mat3::Zero();
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Vec3 rate = parent.rotation[row].transpose() * (child.rate[row] - parent.rate[row]);
    spread += rate * rate.transpose();
  }
  return symmetric_eigen(spread).vectors.col(2);
}

/// The same line seen from the child: nearly constant there.
Vec3 axis_in_child(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child,
                   const Vec3& axis) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t row = 0; row < motion.rows(); ++row)
    if (motion.usable[row]) sum += relative_rotation(parent, child, row).transpose() * axis;
  return sum.normalized();
}

/// q of parent_R_child = A Rz(q) Bᵀ, continuous.
std::vector<double> twist(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child,
                          const Mat3& a, const Mat3& b) {
  std::vector<double> angles;
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Mat3 turn = a.transpose() * relative_rotation(parent, child, row) * b;
    const double angle = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
    angles.push_back(angles.empty() ? angle : angles.back() + wrapped(angle - angles.back()));
  }
  return angles;
}

/// The relative displacement along an axis, from the difference of accelerations twice summed up; its drift is taken
/// off by a parabola between the ends, which is where the fit takes over.
std::vector<double> slid(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child,
                         const Vec3& axis) {
  std::vector<double> place(motion.rows(), 0.0);
  double rate = 0.0;
  for (std::size_t row = 1; row < motion.rows(); ++row) {
    const Vec3 difference = parent.rotation[row].transpose() * (child.acceleration[row] - parent.acceleration[row]);
    rate = 0.999 * rate + motion.period * axis.dot(difference);
    place[row] = 0.999 * place[row - 1] + motion.period * rate;
  }
  return place;
}

Vec3 sliding_axis(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  Mat3 spread = Mat3::Zero();
  for (std::size_t row = motion.first_motion; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Vec3 difference = parent.rotation[row].transpose() * (child.acceleration[row] - parent.acceleration[row]);
    spread += difference * difference.transpose();
  }
  return symmetric_eigen(spread).vectors.col(2);
}

Mat3 home_rotation(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  std::vector<Mat3> turns;
  for (std::size_t row = 0; row < motion.rows(); ++row) turns.push_back(relative_rotation(parent, child, row));
  return mean_rotation(turns);
}

}  // namespace

Mat3 frame_along(const Vec3& axis) {
  Mat3 frame;
  frame.col(2) = axis.normalized();
  frame.col(0) = any_perpendicular(axis).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

JointStart joint_start(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent, std::size_t child,
                       FoundJointType type) {
  const SegmentMotion &p = motion.segments[parent], &c = motion.segments[child];
  const PairFit& pair = tree.pair(parent, child);
  JointStart start{.parent = parent, .child = child, .type = type};
  start.point_in_parent = pair.first == parent ? pair.point_in_first : pair.point_in_second;
  start.point_in_child = pair.first == parent ? pair.point_in_second : pair.point_in_first;
  if (type == FoundJointType::revolute) {
    const Vec3 axis = turning_axis(motion, p, c);
    start.parent_R_axis = frame_along(axis);
    start.child_R_axis = frame_along(axis_in_child(motion, p, c, axis));
    start.reading = twist(motion, p, c, start.parent_R_axis, start.child_R_axis);
    return start;
  }
  const Mat3 home = home_rotation(motion, p, c);
  const Vec3 axis = type == FoundJointType::prismatic ? sliding_axis(motion, p, c) : Vec3(home.col(2));
  start.parent_R_axis = frame_along(axis);
  start.child_R_axis = home.transpose() * start.parent_R_axis;
  start.point_in_parent -= home * start.point_in_child;
  start.point_in_child.setZero();
  if (type == FoundJointType::prismatic) start.reading = slid(motion, p, c, axis);
  return start;
}

}  // namespace kinfer
