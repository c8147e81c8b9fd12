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

/// The relative displacement along an axis, from the difference of accelerations twice summed up with a memory of some
/// seconds, so that it does not drift away; slow slides are left to the fit.
std::vector<double> slid(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child,
                         const Vec3& axis) {
  constexpr double memory = 5.0;  // [s]
  const double kept = std::exp(-motion.period / memory);
  std::vector<double> place(motion.rows(), 0.0);
  double rate = 0.0;
  for (std::size_t row = 1; row < motion.rows(); ++row) {
    const Vec3 difference = parent.rotation[row].transpose() * (child.acceleration[row] - parent.acceleration[row]);
    rate = kept * rate + motion.period * axis.dot(difference);
    place[row] = kept * place[row - 1] + motion.period * rate;
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

/// What a pair of neighbours says.
struct Pair {
  const RecordedMotion& motion;
  const SegmentMotion &parent, &child;
  Vec3 point_in_parent, point_in_child;
};

void start_hinge(JointStart& start, const Pair& pair) {
  const Vec3 axis = turning_axis(pair.motion, pair.parent, pair.child);
  const Mat3 a = frame_along(axis), b = frame_along(axis_in_child(pair.motion, pair.parent, pair.child, axis));
  start.bodies = {turning_body(-1, -1, a, b)};
  start.readings = {twist(pair.motion, pair.parent, pair.child, a, b)};
}

void start_slide_or_mount(JointStart& start, const Pair& pair) {
  const Mat3 home = home_rotation(pair.motion, pair.parent, pair.child);
  if (start.type == FoundJointType::prismatic) {
    const Vec3 axis = sliding_axis(pair.motion, pair.parent, pair.child);
    const Mat3 a = frame_along(axis);
    start.bodies = {sliding_body(-1, -1, a, home.transpose() * a)};
    start.readings = {slid(pair.motion, pair.parent, pair.child, axis)};
  } else {
    start.bodies = {fixed_body(-1, -1, home)};
  }
  start.bodies.front().point_in_parent = pair.point_in_parent - home * pair.point_in_child;
}

/// parent_R_child = exp(φ) · mean orientation, φ continuous.
void start_ball(JointStart& start, const Pair& pair) {
  const Mat3 home = home_rotation(pair.motion, pair.parent, pair.child);
  start.readings.resize(3);
  Vec3 before = Vec3::Zero();
  for (std::size_t row = 0; row < pair.motion.rows(); ++row) {
    Vec3 vector = log_so3(relative_rotation(pair.parent, pair.child, row) * home.transpose());
    const double angle = vector.norm();
    if (angle > 1e-6) {  // the other vector of the same rotation may be the nearer one
      const Vec3 other = vector * (1.0 - 2.0 * std::numbers::pi / angle);
      if ((other - before).norm() < (vector - before).norm()) vector = other;
    }
    before = vector;
    for (std::size_t k = 0; k < 3; ++k) start.readings[k].push_back(vector[static_cast<Eigen::Index>(k)]);
  }
  start.bodies = {ball_body(-1, -1, home)};
}

/// Axes a in the parent and b in the child that the relative rate lies in the plane of, at every time: minimises
/// Σ (ω_rel · (a × R b))², by turns in a and in b.
std::pair<Vec3, Vec3> cross_axes(const Pair& pair) {
  const RecordedMotion& motion = pair.motion;
  Vec3 a = turning_axis(motion, pair.parent, pair.child), b = Vec3::UnitZ();
  constexpr int turns = 50;
  for (int turn = 0; turn < turns; ++turn) {
    Mat3 for_b = Mat3::Zero(), for_a = Mat3::Zero();
    for (std::size_t row = 0; row < motion.rows(); ++row) {
      if (!motion.usable[row]) continue;
      const Mat3 r = relative_rotation(pair.parent, pair.child, row);
      const Vec3 rate = pair.parent.rotation[row].transpose() * (pair.child.rate[row] - pair.parent.rate[row]);
      const Vec3 of_b = r.transpose() * rate.cross(a);  // (ω × a) · R b
      for_b += of_b * of_b.transpose();
    }
    b = symmetric_eigen(for_b).vectors.col(0);
    for (std::size_t row = 0; row < motion.rows(); ++row) {
      if (!motion.usable[row]) continue;
      const Vec3 rate = pair.parent.rotation[row].transpose() * (pair.child.rate[row] - pair.parent.rate[row]);
      const Vec3 of_a = (relative_rotation(pair.parent, pair.child, row) * b).cross(rate);
      for_a += of_a * of_a.transpose();
    }
    a = symmetric_eigen(for_a).vectors.col(0);
  }
  return {a, b};
}

/// parent_R_child = A Rz(q1) C Rz(q2) Bᵀ, C takes z to the second axis as the body between sees it.
void start_cross(JointStart& start, const Pair& pair) {
  const auto [first, second] = cross_axes(pair);
  const RecordedMotion& motion = pair.motion;
  // x of the first frame along the second axis at the start, so that the axes meet in the x-z plane.
  const Mat3 home = relative_rotation(pair.parent, pair.child, motion.first_motion);
  Mat3 a;
  a.col(2) = first;
  const Vec3 across = home * second - first * first.dot(home * second);
  a.col(0) = across.norm() > 1e-3 ? Vec3(across.normalized()) : any_perpendicular(first).normalized();
  a.col(1) = a.col(2).cross(a.col(0));
  const double tilt = angle_between(first, Vec3(home * second));
  const Mat3 c = rot_y(tilt);
  const Mat3 b = frame_along(second);
  start.readings.resize(2);
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Mat3 m = a.transpose() * relative_rotation(pair.parent, pair.child, row) * b;
    const double q1 = std::atan2(m(1, 2), m(0, 2));
    const Mat3 rest = c.transpose() * rot_z(-q1) * m;
    const std::array<double, 2> q{q1, std::atan2(rest(1, 0) - rest(0, 1), rest(0, 0) + rest(1, 1))};
    for (std::size_t k = 0; k < 2; ++k) {
      auto& reading = start.readings[k];
      reading.push_back(reading.empty() ? q[k] : reading.back() + wrapped(q[k] - reading.back()));
    }
  }
  start.bodies = {turning_body(-1, -1, a, Mat3::Identity()), turning_body(-1, -1, c, b)};
  InsBody &near = start.bodies[0], &far = start.bodies[1];
  near.free_child_turn = {};
  far.free_parent_turn = {false, true, false};
  near.free_point_in_child = far.free_point_in_parent = false;
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
  const PairFit& fit = tree.pair(parent, child);
  const bool in_order = fit.first == parent;
  const Pair pair{motion, motion.segments[parent], motion.segments[child],
                  in_order ? fit.point_in_first : fit.point_in_second,
                  in_order ? fit.point_in_second : fit.point_in_first};
  JointStart start{.parent = parent, .child = child, .type = type};
  if (type == FoundJointType::prismatic || type == FoundJointType::rigid) {
    start_slide_or_mount(start, pair);
  } else {
    if (type == FoundJointType::revolute) start_hinge(start, pair);
    if (type == FoundJointType::universal) start_cross(start, pair);
    if (type == FoundJointType::spherical) start_ball(start, pair);
    start.bodies.front().point_in_parent = pair.point_in_parent;
    start.bodies.front().free_point_in_parent = true;
    start.bodies.back().point_in_child = pair.point_in_child;
    start.bodies.back().free_point_in_child = true;
  }
  start.bodies.back().sensor = static_cast<int>(child);
  return start;
}

}  // namespace kinfer
