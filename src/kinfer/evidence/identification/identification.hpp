// SPDX-License-Identifier: Apache-2.0
// Result of an identification: the joints of an unknown machine in the frames of its sensors, how they were found, and
// their uncertainty.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/evidence/facts/verdict.hpp"
#include "kinfer/evidence/identification/chain_update.hpp"
#include "kinfer/evidence/identification/identification_facts.hpp"
#include "kinfer/evidence/identification/joint_estimate.hpp"
#include "kinfer/evidence/identification/joint_verdict.hpp"
#include "kinfer/evidence/identification/traces.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The distance between two joint axes that are parallel as machines are built, as a tape measures it from pin to pin:
/// across the mean direction of both axes, in the plane through the origin of the segment's sensor.
struct PinDistance {
  double distance = 0.0, sd = 0.0;  ///< [m]
  Vec3 direction = Vec3::UnitX();   ///< unit, from the first pin to the second, in the sensor's frame
  double direction_sd = 0.0;        ///< [rad] about the mean axis
};

/// How the axis lines of the two joints of a segment lie relative to each other.
struct LinkEstimate {
  std::string segment, from, to;  ///< sensor; joints as "ins1-ins2"
  double length = 0.0, sd = 0.0;  ///< [m] the shortest distance between the two lines
  double axis_angle = 0.0;        ///< [rad] between the two lines, 0 to π/2; NaN where a joint has a centre, no axis
  std::optional<PinDistance> pin{};  ///< where the axes are nearly parallel
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
  /// The same of the joint that is written, where that is not the search's own: the search's chain is then what a
  /// competitor of it attains. None: it is the search's.
  std::optional<LinkFit> written_fitted{}, written_holdout{};
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
  /// Of the spanning tree: exp of the smallest difference of weights; 2 is safe. None if there is no other tree.
  std::optional<double> margin{};
  std::vector<PhaseEvidence> phases;
  std::vector<int> rank;      ///< table 3's sums
  bool phases_agree = false;  ///< the phases give the same parents as the tree
};

/// How the chain of a link was searched.
enum class LinkSearchMethod { memetic, bacterial, enumeration };
std::string_view name(LinkSearchMethod method);  ///< "bmp", "bp", "enum"

/// How well the chain predicts the measured accelerations.
struct PredictionSummary {
  double held_out_seconds = 0.0;    ///< [s] length of the windows that were not fitted; 0: there are none
  double worst_acceleration = 0.0;  ///< [m/s²] rms residual of the worst sensor, in these windows if there are any
};

struct Identification {
  std::string root;
  std::vector<JointEstimate> joints;  ///< parents before children
  std::vector<LoopEstimate> loops;    ///< joints that close kinematic loops
  std::vector<LinkEstimate> links;
  std::vector<PointEstimate> places;
  std::vector<SensorClockEstimate> clocks;  ///< one per sensor; empty if all clocks agree
  std::vector<JointForecast> forecast;
  AccuracyTarget target{};        ///< of the forecast
  std::vector<DhRowEstimate> dh;  ///< canonical: two rows more than a joint has axes
  std::vector<LinkEvidence> searches;
  bool starts_from_search = false;  ///< the fit began at the joints of the searches, which led to a better optimum
  OrderEvidence order;
  Chain chain;  ///< from the root's sensor; the other sensors are fixed frames
  LinkSearchMethod search_method = LinkSearchMethod::memetic;
  MotionEvidence motion;          ///< predicted and measured signals, joint trajectory
  std::vector<Finding> findings;  ///< what is wrong with the recording, and what was done about it
  std::vector<IdentificationNote> notes;
  std::vector<IdentificationAdvice> advice;  ///< what to measure or to do next, most useful first
  PredictionSummary prediction;
  std::vector<JointVerdict> verdicts;  ///< of each joint, in the same order
  /// do_not_use: a fault that was not corrected, or a joint against which the evidence is; use_with_care: a joint is
  /// less certain or less accurate than wanted.
  Usability usability = Usability::use;
  std::optional<ChainUpdate> update{};  ///< what changed since an earlier identification, whose chain this one updates
  std::optional<TrackingModel> tracking{};  ///< of the continuous-time fit; none where the search's geometry is used
};

}  // namespace kinfer
