// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/initial_joint.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/identify/geometry/thresholds.hpp"
#include "kinfer/identify/structure/slide_fit.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

Mat3 relative_rotation(const SegmentMotion& parent, const SegmentMotion& child, std::size_t row) {
  return parent.rotation[row].transpose() * child.rotation[row];
}

/// Principal direction of the relative angular velocities, in the parent frame.
Vec3 rotation_axis(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  Mat3 spread = Mat3::Zero();
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Vec3 angular_velocity =
        parent.rotation[row].transpose() * (child.angular_velocity[row] - parent.angular_velocity[row]);
    spread += angular_velocity * angular_velocity.transpose();
  }
  return symmetric_eigen(spread).vectors.col(2);
}

/// The same direction in the child frame, where it is nearly constant: its mean.
Vec3 axis_in_child(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child,
                   const Vec3& axis) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t row = 0; row < motion.rows(); ++row)
    if (motion.usable[row]) sum += relative_rotation(parent, child, row).transpose() * axis;
  return sum.normalized();
}

/// q of parent_R_child = A Rz(q) Bᵀ, unwrapped.
std::vector<double> revolute_positions(const RecordedMotion& motion, const SegmentMotion& parent,
                                       const SegmentMotion& child, const Mat3& a, const Mat3& b) {
  std::vector<double> angles;
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Mat3 turn = a.transpose() * relative_rotation(parent, child, row) * b;
    const double angle = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
    angles.push_back(angles.empty() ? angle : angles.back() + wrap_to_pi(angle - angles.back()));
  }
  return angles;
}

/// Relative displacement along an axis: the acceleration beyond the point where the slide begins, integrated twice with
/// a forgetting time of a few seconds, which bounds the drift; slow displacements are left to the fit.
std::vector<double> prismatic_positions(const RecordedMotion& motion, const SegmentMotion& parent,
                                        const SegmentMotion& child, const Vec3& axis, const Vec3& offset) {
  constexpr double forgetting_time = 5.0;  // [s]
  const double decay = std::exp(-motion.period / forgetting_time);
  std::vector<double> displacement(motion.rows(), 0.0);
  double velocity = 0.0;
  for (std::size_t row = 1; row < motion.rows(); ++row) {
    velocity = decay * velocity + motion.period * axis.dot(acceleration_beyond(parent, child, offset, row));
    displacement[row] = decay * displacement[row - 1] + motion.period * velocity;
  }
  return displacement;
}

Mat3 mean_relative_rotation(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  std::vector<Mat3> turns;
  for (std::size_t row = 0; row < motion.rows(); ++row) turns.push_back(relative_rotation(parent, child, row));
  return mean_rotation(turns);
}

/// Two adjacent sensors and their common point.
struct SensorPair {
  const RecordedMotion& motion;
  const SegmentMotion &parent, &child;
  Vec3 point_in_parent, point_in_child;
};

void start_revolute(InitialJoint& start, const SensorPair& pair) {
  const Vec3 axis = rotation_axis(pair.motion, pair.parent, pair.child);
  const Mat3 a = frame_with_z_along(axis),
             b = frame_with_z_along(axis_in_child(pair.motion, pair.parent, pair.child, axis));
  start.bodies = {revolute_body(-1, -1, a, b)};
  start.joint_positions = {revolute_positions(pair.motion, pair.parent, pair.child, a, b)};
}

void start_prismatic_or_rigid(InitialJoint& start, const SensorPair& pair) {
  const Mat3 home = mean_relative_rotation(pair.motion, pair.parent, pair.child);
  if (start.type == EstimatedJointType::prismatic) {
    const SlideFit slide = fit_slide(pair.motion, pair.parent, pair.child).value_or(SlideFit{});
    const Mat3 a = frame_with_z_along(slide.axis_in_parent);
    start.bodies = {prismatic_body(-1, -1, a, home.transpose() * a)};
    start.bodies.front().point_in_parent = slide.offset_in_parent;
    start.joint_positions = {
        prismatic_positions(pair.motion, pair.parent, pair.child, slide.axis_in_parent, slide.offset_in_parent)};
  } else {
    start.bodies = {fixed_body(-1, -1, home)};
    start.bodies.front().point_in_parent = pair.point_in_parent - home * pair.point_in_child;
  }
}

/// parent_R_child = exp(φ) · mean orientation, φ continuous in time.
void start_spherical(InitialJoint& start, const SensorPair& pair) {
  const Mat3 home = mean_relative_rotation(pair.motion, pair.parent, pair.child);
  start.joint_positions.resize(3);
  Vec3 before = Vec3::Zero();
  for (std::size_t row = 0; row < pair.motion.rows(); ++row) {
    Vec3 vector = log_so3(relative_rotation(pair.parent, pair.child, row) * home.transpose());
    const double angle = vector.norm();
    if (angle > 1e-6) {  // the equivalent rotation vector may be nearer to the previous one
      const Vec3 other = vector * (1.0 - 2.0 * std::numbers::pi / angle);
      if ((other - before).norm() < (vector - before).norm()) vector = other;
    }
    before = vector;
    for (std::size_t k = 0; k < 3; ++k) start.joint_positions[k].push_back(vector[static_cast<Eigen::Index>(k)]);
  }
  start.bodies = {spherical_body(-1, -1, home)};
}

/// Axes a in the parent and b in the child that span the plane of the relative angular velocity at every time:
/// minimises Σ (ω_rel · (a × R b))², alternating between a and b.
std::pair<Vec3, Vec3> universal_axes(const SensorPair& pair) {
  const RecordedMotion& motion = pair.motion;
  Vec3 a = rotation_axis(motion, pair.parent, pair.child), b = Vec3::UnitZ();
  constexpr int turns = 50;
  for (int turn = 0; turn < turns; ++turn) {
    Mat3 for_b = Mat3::Zero(), for_a = Mat3::Zero();
    for (std::size_t row = 0; row < motion.rows(); ++row) {
      if (!motion.usable[row]) continue;
      const Mat3 r = relative_rotation(pair.parent, pair.child, row);
      const Vec3 angular_velocity = pair.parent.rotation[row].transpose() *
                                    (pair.child.angular_velocity[row] - pair.parent.angular_velocity[row]);
      const Vec3 of_b = r.transpose() * angular_velocity.cross(a);  // (ω × a) · R b
      for_b += of_b * of_b.transpose();
    }
    b = symmetric_eigen(for_b).vectors.col(0);
    for (std::size_t row = 0; row < motion.rows(); ++row) {
      if (!motion.usable[row]) continue;
      const Vec3 angular_velocity = pair.parent.rotation[row].transpose() *
                                    (pair.child.angular_velocity[row] - pair.parent.angular_velocity[row]);
      const Vec3 of_a = (relative_rotation(pair.parent, pair.child, row) * b).cross(angular_velocity);
      for_a += of_a * of_a.transpose();
    }
    a = symmetric_eigen(for_a).vectors.col(0);
  }
  return {a, b};
}

/// q1, q2 of parent_R_child = A Rz(q1) C Rz(q2) Bᵀ, unwrapped.
std::vector<std::vector<double>> universal_positions(const SensorPair& pair, const Mat3& a, const Mat3& c,
                                                     const Mat3& b) {
  std::vector<std::vector<double>> positions(2);
  for (std::size_t row = 0; row < pair.motion.rows(); ++row) {
    const Mat3 m = a.transpose() * relative_rotation(pair.parent, pair.child, row) * b;
    const double sense = c(0, 2) < 0.0 ? -1.0 : 1.0;  // C z = (sin, 0, cos) of the angle between the axes
    const double q1 = std::atan2(sense * m(1, 2), sense * m(0, 2));
    const Mat3 rest = c.transpose() * rot_z(-q1) * m;
    const std::array<double, 2> q{q1, std::atan2(rest(1, 0) - rest(0, 1), rest(0, 0) + rest(1, 1))};
    for (std::size_t k = 0; k < 2; ++k) {
      auto& position = positions[k];
      position.push_back(position.empty() ? q[k] : position.back() + wrap_to_pi(q[k] - position.back()));
    }
  }
  return positions;
}

/// parent_R_child = A Rz(q1) C Rz(q2) Bᵀ, C takes z to the second axis in the intermediate body.
void start_universal(InitialJoint& start, const SensorPair& pair) {
  const auto [first, second] = universal_axes(pair);
  const RecordedMotion& motion = pair.motion;
  // x of the first frame points along the second axis at the start, so that both axes lie in the x-z plane.
  const Mat3 home = relative_rotation(pair.parent, pair.child, motion.first_motion_row);
  Mat3 a;
  a.col(2) = first;
  const Vec3 across = home * second - first * first.dot(home * second);
  a.col(0) = across.norm() > 1e-3 ? Vec3(across.normalized()) : any_perpendicular(first).normalized();
  a.col(1) = a.col(2).cross(a.col(0));
  const double tilt = angle_between(first, Vec3(home * second));
  const Mat3 c = rot_y(tilt);
  const Mat3 b = frame_with_z_along(second);
  start.joint_positions = universal_positions(pair, a, c, b);
  start.bodies = {revolute_body(-1, -1, a, Mat3::Identity()), revolute_body(-1, -1, c, b)};
  InsBody &near = start.bodies[0], &far = start.bodies[1];
  near.free_child_rotation = {};
  far.free_parent_rotation = {false, true, false};
  near.free_point_in_child = far.free_point_in_parent = false;
}

SensorPair sensor_pair(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent, std::size_t child) {
  const PairFit& fit = tree.pair(parent, child);
  const bool in_order = fit.first == parent;
  return {motion, motion.segments[parent], motion.segments[child], in_order ? fit.point_in_first : fit.point_in_second,
          in_order ? fit.point_in_second : fit.point_in_first};
}

/// Whether the outer axes of a joint are where they are known to be, whatever their sense.
bool has_known_axes(const InitialJoint& found, std::span<const InsBody> known) {
  const auto is_near = [](const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) > std::cos(max_known_axis_error); };
  return is_near(found.bodies.front().parent_R_axis.col(2), known.front().parent_R_axis.col(2)) &&
         is_near(found.bodies.back().child_R_axis.col(2), known.back().child_R_axis.col(2));
}

void take_known(InitialJoint& start, const SensorPair& pair, std::span<const InsBody> known) {
  const int sensor = start.bodies.back().sensor;
  start.bodies.assign(known.begin(), known.end());
  start.bodies.back().sensor = sensor;
  const Mat3 &a = known.front().parent_R_axis, &b = known.back().child_R_axis;
  if (start.type == EstimatedJointType::revolute)
    start.joint_positions = {revolute_positions(pair.motion, pair.parent, pair.child, a, b)};
  if (start.type == EstimatedJointType::universal)
    start.joint_positions = universal_positions(pair, a, known.back().parent_R_axis, b);
  if (start.type == EstimatedJointType::prismatic)
    start.joint_positions = {
        prismatic_positions(pair.motion, pair.parent, pair.child, a.col(2), known.front().point_in_parent)};
}

}  // namespace

InitialJoint estimate_initial_joint(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                                    std::size_t child, EstimatedJointType type) {
  const SensorPair pair = sensor_pair(motion, tree, parent, child);
  InitialJoint start{.parent = parent, .child = child, .type = type};
  if (type == EstimatedJointType::prismatic || type == EstimatedJointType::rigid) {
    start_prismatic_or_rigid(start, pair);
  } else {
    if (type == EstimatedJointType::revolute) start_revolute(start, pair);
    if (type == EstimatedJointType::universal) start_universal(start, pair);
    if (type == EstimatedJointType::spherical) start_spherical(start, pair);
    start.bodies.front().point_in_parent = pair.point_in_parent;
    start.bodies.front().free_point_in_parent = true;
    start.bodies.back().point_in_child = pair.point_in_child;
    start.bodies.back().free_point_in_child = true;
  }
  start.bodies.back().sensor = static_cast<int>(child);
  return start;
}

InitialJoint initial_joint_at(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                              const JointEstimate& revolute) {
  const Mat3 a = frame_with_z_along(revolute.axis_in_parent), b = frame_with_z_along(revolute.axis_in_child);
  InitialJoint start{.parent = parent, .child = child, .type = EstimatedJointType::revolute};
  start.bodies = {revolute_body(-1, -1, a, b)};
  start.joint_positions = {revolute_positions(motion, motion.segments[parent], motion.segments[child], a, b)};
  InsBody& body = start.bodies.front();
  body.point_in_parent = revolute.point_in_parent;
  body.point_in_child = revolute.point_in_child;
  body.free_point_in_parent = body.free_point_in_child = true;
  body.sensor = static_cast<int>(child);
  return start;
}

InitialJoint initial_joint_from(const RecordedMotion& motion, const SegmentTree& tree, std::size_t parent,
                                std::size_t child, EstimatedJointType type, std::span<const InsBody> known) {
  InitialJoint start = estimate_initial_joint(motion, tree, parent, child, type);
  start.positive_axis = {known.front().parent_R_axis.col(2), known.back().child_R_axis.col(2)};
  const bool has_one_axis = type == EstimatedJointType::revolute || type == EstimatedJointType::prismatic;
  if (type == EstimatedJointType::spherical) {
    start.bodies.front().point_in_parent = known.front().point_in_parent;
    start.bodies.back().point_in_child = known.back().point_in_child;
  } else if (has_known_axes(start, known) || !(has_one_axis || type == EstimatedJointType::rigid)) {
    take_known(start, sensor_pair(motion, tree, parent, child), known);
  }
  return start;
}

}  // namespace kinfer::identify
