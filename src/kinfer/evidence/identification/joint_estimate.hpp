// SPDX-License-Identifier: Apache-2.0
// An identified joint in the frames of its two sensors, its uncertainty, and the forecast of what more excitation
// gives.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/facts/estimated_joint_type.hpp"
#include "kinfer/evidence/facts/unobservable.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Standard deviations of a joint's axis and point in the two directions across the axis, in each sensor's frame.
struct JointStandardDeviation {
  std::array<double, 2> axis_in_parent{}, axis_in_child{};    ///< [rad]
  std::array<double, 2> point_in_parent{}, point_in_child{};  ///< [m]
  double along_axis = 0.0;                                    ///< [m] between the two sensors, along the axis
};

/// A joint's axis line in the frames of its two sensors. A spherical joint has a centre and no axis; a universal joint
/// has one axis fixed in the parent and one fixed in the child, both through its centre. The two points are the same
/// physical point (at joint position 0); both axes point in the positive sense of the joint position.
struct JointEstimate {
  std::string parent{}, child{};  ///< sensors; the parent is nearer to the root
  EstimatedJointType type = EstimatedJointType::revolute;
  /// Of the types; none where the type was given, or not weighed: of two segments without a connection.
  std::optional<JointTypeProbabilities> type_probabilities{};
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();  ///< [m]
  JointStandardDeviation sd{};
  std::vector<Unobservable> unobservable{};
  std::vector<Vec3> unobservable_in_parent{}, unobservable_in_child{};  ///< unit directions of the point
  bool azimuth_unobservable = false;
  /// Its trajectory: one row for each of its joint variables in the chain, one column for each time of
  /// MotionEvidence::trajectory [rad] or [m]; empty where only the orientations of its two sensors are known.
  MatrixXd trajectory{};
};

/// A revolute joint outside the tree: it closes a kinematic loop. Between two sensors that the tree joins by three
/// joints or more, `joint.parent` being the first of them in the tree; without trajectory.
struct LoopEstimate {
  JointEstimate joint{};
  std::vector<std::string> segments{};  ///< sensors on the loop's segments
  double gap = 0.0;           ///< [m] rms distance of the joint's two halves in a fit that leaves the loop open
  double misalignment = 0.0;  ///< [rad] the same of its axes
  double mirrored_gap = 0.0;  ///< [m] the gap that joints which merely move in step would leave
  double log_odds = 0.0;      ///< ln of the posterior odds of a closed loop
};

/// Whether the recording determines anything of a joint's axis, or of its point, in one of its sensors; what it does
/// not determine at all has no coordinates in files and on screens. A spherical joint has no axis.
bool is_axis_known(const JointEstimate& joint, const std::array<double, 2>& axis_sd);
bool is_point_known(const std::array<double, 2>& point_sd, const std::vector<Vec3>& unobservable);

/// Whether the recording determines anything of the joint's axis and of its point as the child sees them: what lies
/// beyond the joint follows from these. A child that never turns sees no point; then the parent must. An azimuth that
/// is unobservable is listed as such, and a spherical joint has no axis to be known.
bool is_direction_known(const JointEstimate& joint);
bool is_line_known(const JointEstimate& joint);

/// "ins1-ins2": parent and child.
std::string joint_name(const JointEstimate& joint);

/// Whether no joint moves: all sensors are on one body.
bool is_one_body(const std::vector<JointEstimate>& joints);

/// Probability that the type is the stated one; 1 where it was not weighed.
double type_probability(const JointEstimate& joint);

/// The same of all types together.
double probability_of_types(const std::vector<JointEstimate>& joints);

/// Confidence at which types, lines and directions are wanted.
inline constexpr double wanted_confidence = 0.95;

/// Accuracy wanted of every joint, at 95 % confidence.
struct AccuracyTarget {
  double line = 5e-3;       ///< [m]
  double direction = 3e-3;  ///< [rad]
};

/// Whether the recording determines a joint to the wanted accuracy and, if not, how much more excitation is needed.
struct JointForecast {
  std::string joint;  ///< "ins1-ins2"
  /// [m], [rad] across the axis, of the worse of the two sensors; infinite where it is unknown in the child.
  double line_sd = 0.0, direction_sd = 0.0;
  /// The parent, where it rotates about one fixed axis only: the joint's azimuth about that axis is then nearly
  /// unobservable on level ground and is excluded from the figures above. Empty: nothing is excluded.
  std::string azimuth_of{};
  double azimuth_sd = 0.0;               ///< [rad]
  bool azimuth_is_uncertain = false;     ///< less accurate than wanted of any direction
  bool azimuth_is_unobservable = false;  ///< its standard deviation is that of its prior
  bool is_sufficient = false;
  double acceleration_factor = 1.0, time_factor = 1.0;  ///< factors on those of the recording: either suffices
  bool more_excitation_suffices = true;  ///< a faster or longer recording of the same kind can determine the joint
};

/// Whether the recording determines anything of the joint's line and of its direction. What is not finite is stored as
/// null, which is read as NaN.
bool is_determined(const JointForecast& forecast);

/// Whether every joint is determined to the wanted accuracy.
bool all_sufficient(const std::vector<JointForecast>& joints);

}  // namespace kinfer
