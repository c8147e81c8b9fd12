// SPDX-License-Identifier: Apache-2.0
// Ground truth for identification: the axis of each joint in the frames of its two adjacent sensors, and what is
// unobservable about it from this motion.
//
// The position r of a sensor affects its accelerometer by K r with K = skew(ω̇) + skew(ω)² in its own frame, so
// directions v with K v = 0 at all times are unobservable (docs/development/methods/simulation.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// The axis of one joint; its positive sense is that of the joint position.
struct JointTruth {
  std::string name;           ///< "boom"
  std::string parent, child;  ///< sensors; parent nearer the root
  JointType type = JointType::revolute;
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  /// [m] the same physical point at q = 0: the point of the axis nearest to the child's origin
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();
  std::vector<Vec3> unobservable_in_parent{}, unobservable_in_child{};  ///< unit; unobservable directions of the point
  bool is_axial_offset_observable = true;  ///< the sensors' offset along the axis is observable
  bool heading_needs_magnetometer =
      false;  ///< the child rotates about the vertical only: its heading is observable from its magnetometer alone
};

/// The shortest distance between the axis lines of the joints at both ends of a segment.
struct LinkTruth {
  std::string segment;                   ///< its sensor
  std::string from, to;                  ///< joints, as "ins1-ins2"
  double length = 0.0;                   ///< [m] shortest distance of the two axes
  double axis_angle = 0.0;               ///< [rad] between the two axes, 0 to π/2
  std::optional<double> pin_distance{};  ///< [m] across the mean axis, level with the sensor; of axes within 45°
};

struct MachineTruth {
  std::string root;  ///< sensor
  std::vector<JointTruth> joints;
  std::vector<JointTruth> loops;  ///< joints that close kinematic loops, between the sensors on the bodies they join
  std::vector<LinkTruth> links;   ///< between revolute joints
};

MachineTruth machine_truth(const Machine& machine, const MachineMotion& motion);

}  // namespace kinfer
