// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/ground_truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/frame_motion.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double least_signal = 1e-3;     // [1/s²] rms acceleration per metre below which a direction is unobservable
constexpr double vertical_within = 1e-3;  // [rad]

/// Excitation of a sensor, as second moments over all rows.
struct SensorExcitation {
  Mat3 acceleration_per_metre = Mat3::Zero();  ///< mean of KᵀK, sensor's frame
  Mat3 rate_world = Mat3::Zero();              ///< mean of ω ωᵀ, world frame
};

std::vector<SensorExcitation> compute_excitation(const Machine& machine, const MachineMotion& motion) {
  std::vector<SensorExcitation> sums(machine.sensors.size());
  const Eigen::Index rows = motion.q.cols();
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto frames = joint_motions(machine.chain, motion.q.col(row), motion.qd.col(row), motion.qdd.col(row));
    for (std::size_t s = 0; s < sums.size(); ++s) {
      const FrameMotion& frame = frames[machine.sensors[s].joint];
      const Mat3 sensor_R_world = (frame.pose.rotation * machine.sensors[s].segment_T_sensor.rotation).transpose();
      const Mat3 w = skew(sensor_R_world * frame.omega), k = skew(sensor_R_world * frame.alpha) + w * w;
      sums[s].acceleration_per_metre += k.transpose() * k / static_cast<double>(rows);
      sums[s].rate_world += frame.omega * frame.omega.transpose() / static_cast<double>(rows);
    }
  }
  return sums;
}

std::vector<Vec3> find_unobservable_directions(const Mat3& acceleration_per_metre) {
  const SymmetricEigen eigen = symmetric_eigen(acceleration_per_metre);
  std::vector<Vec3> hidden;
  for (int i = 0; i < 3; ++i)
    if (eigen.values[i] < least_signal * least_signal) hidden.push_back(eigen.vectors.col(i));
  return hidden;
}

bool rotates_about_vertical_only(const SensorExcitation& excitation) {
  const double all = excitation.rate_world.trace(), about_up = excitation.rate_world(2, 2);
  return all > 0.0 && all - about_up < vertical_within * vertical_within * all;
}

/// The moving joint between a sensor and its parent; our machines have one per segment.
int checked_joint(const Machine& machine, const MountedSensor& sensor) {
  const Joint& joint = machine.chain.joints[sensor.joint];
  KINFER_EXPECT(has_position(joint.type) && joint.parent == machine.sensors[sensor.parent].joint,
                "{} hangs on {} by one joint", sensor.name, machine.sensors[sensor.parent].name);
  return sensor.joint;
}

JointTruth joint_truth(const Machine& machine, const MountedSensor& child) {
  const MountedSensor& parent = machine.sensors[child.parent];
  const Joint& joint = machine.chain.joints[checked_joint(machine, child)];
  const auto& link = std::get<UrdfLink>(joint.link);
  const Pose joint_T_child = child.segment_T_sensor,
             parent_T_joint = parent.segment_T_sensor.inverse() * link.origin.pose();
  JointTruth truth{.name = joint.name, .parent = parent.name, .child = child.name, .type = joint.type};
  truth.axis_in_parent = parent_T_joint.rotation * link.axis;
  truth.axis_in_child = joint_T_child.rotation.transpose() * link.axis;
  // The location of a prismatic axis is arbitrary: it is put through the child's origin. A revolute one passes the
  // joint's.
  const Vec3 along = link.axis.dot(joint_T_child.position) * link.axis;
  const Vec3 point_in_joint = translates(joint.type) ? joint_T_child.position : along;
  truth.point_in_parent = parent_T_joint * point_in_joint;
  truth.point_in_child = joint_T_child.inverse() * point_in_joint;
  return truth;
}

/// The sensor carried by a joint's frame.
const MountedSensor& sensor_on(const Machine& machine, int joint) {
  const auto found = std::ranges::find(machine.sensors, joint, &MountedSensor::joint);
  KINFER_EXPECT(found != machine.sensors.end(), "no sensor on joint {}", joint);
  return *found;
}

JointTruth loop_truth(const Machine& machine, const LoopClosure& closure) {
  const MountedSensor &first = sensor_on(machine, closure.first), &second = sensor_on(machine, closure.second);
  const Pose first_T_frame = first.segment_T_sensor.inverse(), second_T_frame = second.segment_T_sensor.inverse();
  JointTruth truth{.name = closure.name, .parent = first.name, .child = second.name};
  truth.axis_in_parent = first_T_frame.rotation * closure.axis_in_first;
  truth.axis_in_child = second_T_frame.rotation * closure.axis_in_second;
  truth.point_in_parent = first_T_frame * closure.point_in_first;
  truth.point_in_child = second_T_frame * closure.point_in_second;
  return truth;
}

double distance_of_lines(const Vec3& point_a, const Vec3& axis_a, const Vec3& point_b, const Vec3& axis_b) {
  const Vec3 across = axis_a.cross(axis_b), between = point_b - point_a;
  if (across.norm() < 1e-9) return (between - axis_a.dot(between) * axis_a).norm();  // parallel
  return std::abs(between.dot(across.normalized()));
}

/// Between the points where the lines meet the plane through the sensor's origin across their mean direction.
std::optional<double> distance_of_pins(const Vec3& point_a, const Vec3& axis_a, const Vec3& point_b,
                                       const Vec3& axis_b) {
  const double cosine = axis_a.dot(axis_b);
  if (std::abs(cosine) < std::numbers::sqrt2 / 2.0) return {};
  const Vec3 normal = axis_a + std::copysign(1.0, cosine) * axis_b;
  const auto meets = [&](const Vec3& point, const Vec3& axis) -> Vec3 {
    return point - normal.dot(point) / normal.dot(axis) * axis;
  };
  return (meets(point_b, axis_b) - meets(point_a, axis_a)).norm();
}

std::vector<LinkTruth> links_between(const std::vector<JointTruth>& joints) {
  std::vector<LinkTruth> links;
  for (const JointTruth& in : joints)
    for (const JointTruth& out : joints)
      if (out.parent == in.child && rotates(in.type) && rotates(out.type))
        links.push_back(
            {in.child, fmt::format("{}-{}", in.parent, in.child), fmt::format("{}-{}", out.parent, out.child),
             distance_of_lines(in.point_in_child, in.axis_in_child, out.point_in_parent, out.axis_in_parent),
             std::atan2(in.axis_in_child.cross(out.axis_in_parent).norm(),
                        std::abs(in.axis_in_child.dot(out.axis_in_parent))),
             distance_of_pins(in.point_in_child, in.axis_in_child, out.point_in_parent, out.axis_in_parent)});
  return links;
}

}  // namespace

MachineTruth machine_truth(const Machine& machine, const MachineMotion& motion) {
  const std::vector<SensorExcitation> excitation = compute_excitation(machine, motion);
  MachineTruth truth{.root = machine.sensors.front().name, .joints = {}, .loops = {}, .links = {}};
  for (std::size_t s = 1; s < machine.sensors.size(); ++s) {
    const auto parent = static_cast<std::size_t>(machine.sensors[s].parent);
    JointTruth joint = joint_truth(machine, machine.sensors[s]);
    const Mat3& moved = excitation[parent].acceleration_per_metre;
    joint.unobservable_in_parent = find_unobservable_directions(moved);
    joint.unobservable_in_child = find_unobservable_directions(excitation[s].acceleration_per_metre);
    joint.is_axial_offset_observable =
        rotates(joint.type) && joint.axis_in_parent.dot(moved * joint.axis_in_parent) > least_signal * least_signal;
    joint.heading_needs_magnetometer = rotates_about_vertical_only(excitation[s]);
    truth.joints.push_back(std::move(joint));
  }
  truth.links = links_between(truth.joints);
  for (const LoopClosure& closure : machine.chain.closures) truth.loops.push_back(loop_truth(machine, closure));
  return truth;
}

}  // namespace kinfer
