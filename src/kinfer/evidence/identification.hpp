// What an identification delivers: the joints of an unknown machine in the frames of its sensors, how they were found,
// and how far to trust them.
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

enum class FoundJointType { revolute, prismatic, universal, spherical, rigid };
std::string_view name(FoundJointType type);  ///< "revolute", "prismatic", "universal", "spherical", "rigid"

/// One sigma of what describes a joint, across its axis in each sensor's frame.
struct JointDeviation {
  std::array<double, 2> axis_in_parent{}, axis_in_child{};    ///< [rad]
  std::array<double, 2> point_in_parent{}, point_in_child{};  ///< [m]
  double slide = 0.0;                                         ///< [m] of one sensor against the other, along the axis
};

/// A joint's axis line in the frames of the sensors beside it. A spherical joint has a centre and no axis; a universal
/// one has the axis that is fixed in the parent and the one that is fixed in the child, through its centre. Both points
/// are the same physical one (at angle 0), both axes have the sense of the positive joint angle.
struct FoundJoint {
  std::string parent{}, child{};  ///< sensors, parent nearer the root
  FoundJointType type = FoundJointType::revolute;
  Vec3 axis_in_parent = Vec3::UnitZ(), axis_in_child = Vec3::UnitZ();  ///< unit
  Vec3 point_in_parent = Vec3::Zero(), point_in_child = Vec3::Zero();  ///< [m]
  JointDeviation sd{};
  std::vector<std::string> not_identifiable{};                                  ///< in words
  std::vector<Vec3> not_identifiable_in_parent{}, not_identifiable_in_child{};  ///< unit
  bool azimuth_undetermined = false;
  /// How it moved: a row for each of its variables in the chain, a column for each frame of the film [rad] or [m];
  /// empty where only the orientations of its two sensors are known.
  MatrixXd film{};
};

/// Shortest distance between the axis lines of the two joints of a segment.
struct FoundLink {
  std::string segment, from, to;  ///< sensor; joints as "ins1-ins2"
  double length = 0.0, sd = 0.0;  ///< [m]
};

/// A place on a segment that touches, tapes or surveyed points told of: the tool's tip beyond the last sensor.
struct FoundPlace {
  std::string name, sensor;
  Vec3 xyz = Vec3::Zero(), sd = Vec3::Zero();  ///< [m] in the sensor's frame
};

/// How the clock of a sensor was corrected: its times t became t + offset + drift (t − middle of the recording).
struct FoundClock {
  std::string sensor;
  double offset = 0.0, drift = 0.0;        ///< [s], [s/s]
  double offset_sd = 0.0, drift_sd = 0.0;  ///< [s], [s/s]
};

/// Whether the recording is enough for what is wanted of a joint, and what more it would take.
struct JointForecast {
  std::string joint;                         ///< "ins1-ins2"
  double line_sd = 0.0, direction_sd = 0.0;  ///< [m], [rad] of the worse side, across the axis
  /// The parent, where it turns about one fixed axis only: how the joint is turned about that axis leaves hardly a trace
  /// in any signal on level ground (METHODS K's azimuth), and counts apart. Empty: nothing is left out.
  std::string azimuth_of{};
  double azimuth_sd = 0.0;  ///< [rad]
  bool enough = false;
  double acceleration = 1.0, time = 1.0;  ///< times those of the recording: either would do
};

/// One DH transformation RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta) of the chain.
struct FoundDhRow {
  std::string segment;                         ///< sensor that the row leads towards
  DhNumbers row, sd;                           ///< [rad], [m]; beta only where axes are nearly parallel
  std::string theta_variable, alpha_variable;  ///< signal that is added to the angle; empty: none
  std::string d_variable{};                    ///< the same of a slide

  const std::string& variable() const { return d_variable.empty() ? theta_variable : d_variable; }
};

/// Eq. (20) of paper 1 on rows that were fitted or not.
struct FoundFit {
  double total = 0.0;
  double acceleration = 0.0;  ///< [m/s²]
  double orientation = 0.0;   ///< [rad]
};

/// How one segment's sub-tree was evolved.
struct LinkEvidence {
  std::string segment;
  FoundFit fitted, holdout;
  int rows = 0;                    ///< that were fitted
  std::vector<FoundDhRow> found;   ///< the tree's leaves as they were found (paper 1, table 5)
  std::vector<FoundDhRow> merged;  ///< the same product with fewer leaves (table 6)
  std::int64_t evaluations = 0;
  int generations = 0;
  std::vector<double> best, median;  ///< cost of the population after each generation, penalties included (fig. 9)
};

/// Two segments and how well they share a point.
struct PairEvidence {
  std::string first, second;
  double residual = 0.0;       ///< [m/s²]
  double off_axis_rate = 0.0;  ///< [rad/s]
  double weight = 0.0;         ///< [nats] code length of a row of their relative motion; the tree has the least
  bool joined = false;         ///< an edge of the tree
};

/// A row of paper 1's table 3: who moved in one phase.
struct PhaseEvidence {
  double begin = 0.0, end = 0.0;  ///< [s]
  std::vector<bool> moves;        ///< in the order of `sensors`
};

struct OrderEvidence {
  std::vector<std::string> sensors;
  std::vector<PairEvidence> pairs;
  double margin = 0.0;  ///< of the spanning tree: exp of the least difference of weights; 2 is safe
  std::vector<PhaseEvidence> phases;
  std::vector<int> rank;      ///< table 3's sums
  bool phases_agree = false;  ///< the table gives the same parents
};

struct Identification {
  std::string root;
  std::vector<FoundJoint> joints;  ///< parents before children
  std::vector<FoundLink> links;
  std::vector<FoundPlace> places;
  std::vector<FoundClock> clocks;  ///< one a sensor; none where all clocks agree
  std::vector<JointForecast> forecast;
  std::vector<FoundDhRow> dh;  ///< canonical: three rows a joint
  std::vector<LinkEvidence> searches;
  OrderEvidence order;
  Chain chain;            ///< from the root's sensor; one revolute joint a found one, its sensors as fixed frames
  std::string engine;     ///< "bp"
  MotionEvidence motion;  ///< predicted against measured, and the film
  std::vector<Finding> findings;  ///< what is wrong with the recording, and what was done about it
  std::vector<Advice> next;       ///< what to measure or to do next, most useful first
  std::vector<std::string> notes;
  std::string verdict;  ///< one sentence
  bool use = true;      ///< false: something is wrong that makes the chain as a whole unfit for use
};

}  // namespace kinfer
