// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/four_bar_linkage.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/simulate/prescribed_motion.hpp"

namespace kinfer {
namespace {

/// Joint angles of rocker and coupler.
struct LinkageAngles {
  double rocker = 0.0, coupler = 0.0;  // [rad]
};

LinkageAngles solve_linkage(double crank_position, const FourBar& bars) {
  const double phi = crank_position + bars.crank_angle;
  const double x = bars.ground + bars.crank * std::cos(phi), y = bars.crank * std::sin(phi);  // C seen from A
  const double square = x * x + y * y, distance = std::sqrt(square);
  const double cosine =
      (bars.rocker * bars.rocker + square - bars.coupler * bars.coupler) / (2.0 * bars.rocker * distance);
  KINFER_EXPECT(std::abs(cosine) < 1.0, "the bars do not reach at {} rad", crank_position);
  const double rocker = std::atan2(y, x) + std::acos(cosine);
  const double end_x = bars.rocker * std::cos(rocker), end_y = bars.rocker * std::sin(rocker);
  return {rocker, std::atan2(y - end_y, x - end_x) - rocker};
}

/// The last revolute joint.
int driven_joint(const Chain& chain) {
  int last = -1;
  for (std::size_t j = 0; j < chain.joints.size(); ++j)
    if (rotates(chain.joints[j].type)) last = static_cast<int>(j);
  return last;
}

/// Rotation whose z axis is the joint's axis and whose x axis points from the segment's own joint to this one.
Mat3 linkage_plane(const UrdfLink& link) {
  const Vec3 z = link.axis, outward = link.origin.pose().rotation.transpose() * link.origin.xyz;
  Mat3 plane;
  plane.col(2) = z;
  plane.col(0) = (outward - z * z.dot(outward)).normalized();
  plane.col(1) = z.cross(plane.col(0));
  return plane;
}

Joint make_revolute_joint(const char* name, int parent, const Pose& origin) {
  Joint joint{.name = name, .parent = parent, .type = JointType::revolute};
  joint.link = UrdfLink{.origin = Frame::from_pose(origin), .axis = Vec3::UnitZ()};
  return joint;
}

MountedSensor make_sensor(const std::string& name, const char* segment, int joint, int parent, const Vec3& place) {
  const Mat3 turn = exp_so3(Vec3(0.7, -1.1, 0.4) * static_cast<double>(joint));
  return {.name = name, .segment = segment, .joint = joint, .parent = parent, .segment_T_sensor = {turn, place}};
}

int find_sensor_on(const Machine& machine, int joint) {
  for (; joint >= 0; joint = machine.chain.joints[static_cast<std::size_t>(joint)].parent)
    for (std::size_t s = 0; s < machine.sensors.size(); ++s)
      if (machine.sensors[s].joint == joint) return static_cast<int>(s);
  return -1;
}

}  // namespace

Machine with_linkage(Machine machine, const FourBar& bars) {
  const int last = driven_joint(machine.chain);
  KINFER_EXPECT(last > 0);
  const Joint& joint = machine.chain.joints[static_cast<std::size_t>(last)];
  const auto& link = std::get<UrdfLink>(joint.link);
  const Mat3 plane = linkage_plane(link);
  const Vec3 axis = link.axis;  // `link` does not survive the joints added below
  const Pose segment_T_joint = link.origin.pose();
  const Pose segment_T_rocker{segment_T_joint.rotation * plane,
                              segment_T_joint.position - segment_T_joint.rotation * plane.col(0) * bars.ground};
  const int carrier = find_sensor_on(machine, joint.parent), rocker = static_cast<int>(machine.chain.joints.size());
  machine.chain.joints.push_back(make_revolute_joint("rocker", joint.parent, segment_T_rocker));
  machine.chain.joints.push_back(
      make_revolute_joint("coupler", rocker, {Mat3::Identity(), Vec3(bars.rocker, 0.0, 0.0)}));
  // C in the last segment: at the crank's length from B, at the crank's angle in the plane.
  const Vec3 crank =
      plane * Vec3(bars.crank * std::cos(bars.crank_angle), bars.crank * std::sin(bars.crank_angle), 0.0);
  machine.chain.closures.push_back({.name = "linkage",
                                    .first = last,
                                    .second = rocker + 1,
                                    .point_in_first = crank,
                                    .point_in_second = Vec3(bars.coupler, 0.0, 0.0),
                                    .axis_in_first = axis,
                                    .axis_in_second = Vec3::UnitZ()});
  const auto first = static_cast<int>(machine.sensors.size());
  machine.sensors.push_back(make_sensor("rocker", "rocker", rocker, carrier, Vec3(0.2, 0.05, 0.03)));
  machine.sensors.push_back(make_sensor("coupler", "coupler", rocker + 1, first, Vec3(0.15, -0.04, 0.02)));
  machine.home.conservativeResize(machine.home.size() + 2);
  const LinkageAngles home = solve_linkage(machine.home[machine.home.size() - 3], bars);
  machine.home.tail<2>() = Eigen::Vector2d(home.rocker, home.coupler);
  return machine;
}

MachineMotion linkage_motion(const Machine& machine, const Drive& drive, double sampling_rate, const FourBar& bars) {
  const auto follows = [&](double time) { return solve_linkage(state_at(drive.joints.back(), time).q, bars); };
  return prescribed_motion(machine, drive.duration, sampling_rate, [&](double time) {
    constexpr double h = 1e-3;  // [s] step of the finite differences
    std::vector<JointState> states;
    for (const JointTrajectory& joint : drive.joints) states.push_back(state_at(joint, time));
    const LinkageAngles before = follows(time - h), at = follows(time), after = follows(time + h);
    const auto state = [&](double b, double q, double a) {
      return JointState{.q = q, .qd = (a - b) / (2.0 * h), .qdd = (a - 2.0 * q + b) / (h * h)};
    };
    states.push_back(state(before.rocker, at.rocker, after.rocker));
    states.push_back(state(before.coupler, at.coupler, after.coupler));
    return states;
  });
}

}  // namespace kinfer
