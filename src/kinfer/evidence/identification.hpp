// SPDX-License-Identifier: Apache-2.0
// Result of an identification: the joints of an unknown machine in the frames of its sensors, how they were found, and
// their uncertainty.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/advice.hpp"
#include "kinfer/evidence/findings.hpp"
#include "kinfer/evidence/traces.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

enum class EstimatedJointType { revolute, prismatic, universal, spherical, rigid };
std::string_view name(EstimatedJointType type);  ///< "revolute", "prismatic", "universal", "spherical", "rigid"

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
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();  ///< [m]
  JointStandardDeviation sd{};
  std::vector<std::string> unobservable{};                              ///< sentences
  std::vector<Vec3> unobservable_in_parent{}, unobservable_in_child{};  ///< unit directions of the point
  bool azimuth_unobservable = false;
  /// Its trajectory: one row for each of its joint variables in the chain, one column for each time of
  /// MotionEvidence::trajectory [rad] or [m]; empty where only the orientations of its two sensors are known.
  MatrixXd trajectory{};
};

/// Shortest distance between the axis lines of the two joints of a segment.
struct LinkEstimate {
  std::string segment, from, to;  ///< sensor; joints as "ins1-ins2"
  double length = 0.0, sd = 0.0;  ///< [m]
};

/// A point on a segment, located by touches, tape measurements or a survey: e.g. the tool tip beyond the last sensor.
struct PointEstimate {
  std::string name, sensor;
  Vec3 xyz = Vec3::Zero(), sd = Vec3::Zero();  ///< [m] in the sensor's frame
};

/// Correction of a sensor's clock: time t became t + offset + drift (t − middle of the recording).
struct SensorClockEstimate {
  std::string sensor;
  double offset = 0.0, drift = 0.0;        ///< [s], [s/s]
  double offset_sd = 0.0, drift_sd = 0.0;  ///< [s], [s/s]
};

/// Whether the recording determines a joint to the wanted accuracy and, if not, how much more excitation is needed.
struct JointForecast {
  std::string joint;                         ///< "ins1-ins2"
  double line_sd = 0.0, direction_sd = 0.0;  ///< [m], [rad] across the axis, of the worse of the two sensors
  /// The parent, where it rotates about one fixed axis only: the joint's azimuth about that axis is then nearly
  /// unobservable on level ground and is excluded from the figures above. Empty: nothing is excluded.
  std::string azimuth_of{};
  double azimuth_sd = 0.0;  ///< [rad]
  bool is_sufficient = false;
  double acceleration_factor = 1.0, time_factor = 1.0;  ///< factors on those of the recording: either suffices
};

/// One DH transformation RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta) of the chain.
struct DhRowEstimate {
  std::string segment;                         ///< sensor that the row leads to
  DhNumbers row, sd;                           ///< [rad], [m]; beta only where axes are nearly parallel
  std::string theta_variable, alpha_variable;  ///< signal added to the angle; empty: none
  std::string d_variable{};                    ///< signal added to d (prismatic joint)

  const std::string& variable() const { return d_variable.empty() ? theta_variable : d_variable; }
};

/// Cost of eq. (20) of paper 1, on fitted or on held-out rows.
struct LinkFit {
  double total = 0.0;
  double acceleration = 0.0;  ///< [m/s²]
  double orientation = 0.0;   ///< [rad]
};

/// The search for one segment's sub-tree.
struct LinkEvidence {
  std::string segment;
  LinkFit fitted, holdout;
  int rows = 0;                       ///< number of fitted rows
  std::vector<DhRowEstimate> found;   ///< leaves of the best tree (paper 1, table 5)
  std::vector<DhRowEstimate> merged;  ///< the same product, with fewer leaves (table 6)
  std::int64_t evaluations = 0;
  int generations = 0;
  std::vector<double> best, median;  ///< cost of the population after each generation, penalties included (fig. 9)
};

/// How well two segments share a common point.
struct PairEvidence {
  std::string first, second;
  double residual = 0.0;       ///< [m/s²]
  double off_axis_rate = 0.0;  ///< [rad/s]
  double weight = 0.0;         ///< [nats] code length per row of their relative motion; the tree minimises its sum
  bool joined = false;         ///< an edge of the tree
};

/// A row of paper 1's table 3: which sensors moved in one phase.
struct PhaseEvidence {
  double begin = 0.0, end = 0.0;  ///< [s]
  std::vector<bool> moves;        ///< in the order of `sensors`
};

struct OrderEvidence {
  std::vector<std::string> sensors;
  std::vector<PairEvidence> pairs;
  double margin = 0.0;  ///< of the spanning tree: exp of the smallest difference of weights; 2 is safe
  std::vector<PhaseEvidence> phases;
  std::vector<int> rank;      ///< table 3's sums
  bool phases_agree = false;  ///< the phases give the same parents as the tree
};

struct Identification {
  std::string root;
  std::vector<JointEstimate> joints;  ///< parents before children
  std::vector<LinkEstimate> links;
  std::vector<PointEstimate> places;
  std::vector<SensorClockEstimate> clocks;  ///< one per sensor; empty if all clocks agree
  std::vector<JointForecast> forecast;
  std::vector<DhRowEstimate> dh;  ///< canonical: two rows more than a joint has axes
  std::vector<LinkEvidence> searches;
  OrderEvidence order;
  Chain chain;                    ///< from the root's sensor; the other sensors are fixed frames
  std::string engine;             ///< "bmp", "bp" or "enum"
  MotionEvidence motion;          ///< predicted and measured signals, joint trajectory
  std::vector<Finding> findings;  ///< what is wrong with the recording, and what was done about it
  std::vector<Advice> next;       ///< what to measure or to do next, most useful first
  std::vector<std::string> notes;
  std::string verdict;  ///< one sentence
  bool use = true;      ///< false: something is wrong that makes the chain as a whole unfit for use
};

}  // namespace kinfer
