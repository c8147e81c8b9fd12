// What identification ought to find: each joint's axis line in the frames of the two sensors beside it, and what no
// instrument can tell about it from the motion that was made.
//
// A sensor's place matters to its accelerometer by K r with K = skew(ω̇) + skew(ω)² in its own frame, so directions with
// K v = 0 at all times cannot be known (docs/methods/simulation.md).
#pragma once

#include <string>
#include <vector>

#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// The axis line of one joint; its positive sense is that of the joint's reading.
struct JointTruth {
  std::string name;           ///< "boom"
  std::string parent, child;  ///< sensors; parent nearer the root
  JointType type = JointType::revolute;
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  /// [m] the same physical point at q = 0: the axis' nearest to the child's origin
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();
  std::vector<Vec3> hidden_in_parent{}, hidden_in_child{};  ///< unit; moving the point along them changes no signal
  bool slide_observable = true;                             ///< how far along the axis one sensor sits from the other
  bool azimuth_by_field_only =
      false;  ///< the child only ever turns about the vertical: just its magnetometer knows its heading
};

/// The shortest distance between the axis lines of the joints at both ends of a segment.
struct LinkTruth {
  std::string segment;   ///< its sensor
  std::string from, to;  ///< joints, as "ins1-ins2"
  double length = 0.0;   ///< [m]
};

struct MachineTruth {
  std::string root;  ///< sensor
  std::vector<JointTruth> joints;
  std::vector<LinkTruth> links;  ///< between revolute joints
};

MachineTruth machine_truth(const Machine& machine, const MachineMotion& motion);

}  // namespace kinfer
