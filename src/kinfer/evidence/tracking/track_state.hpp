// SPDX-License-Identifier: Apache-2.0
// The state of a tracked machine at one time, with standard deviations.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Where the joint positions of a joint come from.
enum class JointSource {
  none,      ///< unknown: not started, or no sensor shows it
  chain,     ///< the filter on the whole chain
  composed,  ///< the orientations of its two sensors, each filtered alone
};
std::string_view name(JointSource source);

/// What a joint position counts from.
enum class JointReference {
  chain,  ///< the chain's zero
  start,  ///< where tracking started: neither gravity nor motion has shown where that is
};
std::string_view name(JointReference reference);

struct JointStatus {
  JointSource source = JointSource::none;
  JointReference reference = JointReference::chain;
  /// Rotation of the child's segment in its parent's, in the frames of their sensors. Of a loose joint it is more than
  /// its joint position says.
  Quat parent_q_child = Quat::Identity();
};

enum class TrackAlarmKind {
  does_not_fit,      ///< the chain as a whole: another machine's log, or permuted axes
  sensor_moved,      ///< a sensor does not agree with the chain: turned, shifted, on another segment
  joint_changed,     ///< a joint does not: play, bent
  sensor_lost,       ///< no samples
  sensor_stuck,      ///< the same sample again and again
  sensor_clipped,    ///< at its range
  sensor_late,       ///< its clock disagrees
  restarted,         ///< after a gap
  start_wrong,       ///< gravity contradicts where the user says that a joint stands
  sensor_exchanged,  ///< with another sensor: the rows are explained with both in each other's place
};
std::string_view name(TrackAlarmKind kind);

/// Of a sensor that was turned before the first row, as far as the rows show.
struct SensorTurn {
  double angle = 0.0, sd = 0.0;  ///< [rad]
  double hidden_sd = 0.0;        ///< [rad] of a turn about the axis that the motion shows least
  bool operator==(const SensorTurn&) const = default;
};

struct TrackAlarm {
  TrackAlarmKind kind{};
  int sensor = -1, joint = -1;       ///< indices into the model's lists; −1: none
  double since = 0.0;                ///< [s]
  double strength = 0.0;             ///< the test's value over its threshold
  std::optional<SensorTurn> turn{};  ///< of `sensor_moved`, where it was turned before the first row
  bool operator==(const TrackAlarm&) const = default;
};

/// Vectors have their final lengths from the beginning: joint positions in the order of the chain's active joints,
/// joints and sensors in that of the model. Unknown values are NaN.
struct TrackState {
  double time = 0.0;  ///< [s]
  bool started = false;
  VectorXd q, qd, sd_q, sd_qd;           ///< [rad] or [m], per second
  Quat world_q_base = Quat::Identity();  ///< base sensor to world; world: z up, heading 0 at the start
  Vec3 sd_base = Vec3::Zero();           ///< [rad] about the world's axes; z: relative to the start
  Pose base_T_tool{};
  Vec3 sd_tool_position = Vec3::Zero(), sd_tool_rotation = Vec3::Zero();  ///< [m], [rad] about the base sensor's axes
  std::vector<JointStatus> joints{};
  std::vector<double> innovation{};  ///< of each sensor against all others: T over its expectation; 1 is as expected
  std::vector<TrackAlarm> alarms{};  ///< active now
};

}  // namespace kinfer
