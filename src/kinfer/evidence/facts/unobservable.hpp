// SPDX-License-Identifier: Apache-2.0
// Parameters of a joint that a recording does not determine, and the additional measurement that would.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

enum class UnobservableKind {
  point,             ///< the joint's point in a sensor that does not rotate: three directions
  point_across,      ///< two directions: the point is known only along the direction across both
  point_along,       ///< one direction: the only axis that the sensor rotates about
  azimuth,           ///< of the child about an upright axis of constant direction
  place_about_axis,  ///< of axis and point in the parent, about the upright axis of the joint before
  point_on_axis,     ///< of a revolute joint: any point of its axis will do
  axis_position,     ///< of a prismatic joint: any parallel line will do
  joint_axis,        ///< of a joint that did not move
  offset_split,      ///< of d between two consecutive parallel axes: only the sum is known
};

/// The stable identifier for programs: "point", "point_across", ...
std::string_view name(UnobservableKind kind);

/// The additional measurement that would determine it.
enum class UnobservableRemedy {
  none,                       ///< a free choice: no measurement tells, and none is needed
  rock_base_or_measure,       ///< rock or drive the base while recording, or measure by hand
  rotate_segment_or_measure,  ///< rotate the segment about more directions, or measure by hand
  tilt_base_or_magnetometer,  ///< record on a slope, or with a magnetometer
  move_joint,
};
std::string_view name(UnobservableRemedy remedy);  ///< "none", "rock_base_or_measure", ...
UnobservableRemedy remedy(UnobservableKind kind);

struct Unobservable {
  UnobservableKind kind{};
  std::string sensor{};            ///< in whose frame; empty where it concerns the joint as a whole
  std::vector<Vec3> directions{};  ///< unit, in the sensor's frame: shifts of the point that change no signal
  std::string other_joint{};       ///< place_about_axis, offset_split: the joint before, as "ins1-ins2"
};

}  // namespace kinfer
