// SPDX-License-Identifier: Apache-2.0
#include "studies/track/scores.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/track/smooth/smoother.hpp"

namespace kinfer::study::track_study {
namespace {

using Index = Eigen::Index;

/// Truth in the terms of the model: sign and zero of each joint position.
struct TrueJoint {
  Index row = 0;  // of MachineMotion::q
  double zero = 0.0, sign = 1.0;
};

std::size_t sensor_named(const Machine& machine, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(machine.sensors, name, &MountedSensor::name) -
                                  machine.sensors.begin());
}

std::vector<TrueJoint> true_joints(const TrackingModel& model, const SimulatedDrive* identified,
                                   const Machine& machine) {
  std::vector<TrueJoint> joints;
  for (const TrackingBody& body : model.bodies) {
    if (body.joint < 0) continue;
    const std::string& name = model.sensors[static_cast<std::size_t>(body.sensor)].name;
    const std::size_t s = sensor_named(machine, name);
    const std::vector<int> active = active_joints(machine.chain);
    TrueJoint joint{.row = std::ranges::find(active, machine.sensors[s].joint) - active.begin()};
    if (identified != nullptr) joint.zero = identified->motion.q(joint.row, 0);
    const auto& link =
        std::get<UrdfLink>(machine.chain.joints[static_cast<std::size_t>(machine.sensors[s].joint)].link);
    const Vec3 axis = machine.sensors[s].segment_T_sensor.rotation.transpose() * link.axis;
    joint.sign = axis.dot(body.child_R_axis.col(2)) < 0.0 ? -1.0 : 1.0;
    joints.push_back(joint);
  }
  return joints;
}

struct Sum {
  double squares = 0.0, composed = 0.0, stated = 0.0, nees = 0.0, inside = 0.0, start = 0.0, composed_start = 0.0;
  int rows = 0, composed_rows = 0;
};

/// Angle between the true and the estimated vertical in the base.
double tilt_error(const Quat& world_q_base, const Quat& truth) {
  return angle_between(world_q_base.conjugate() * Vec3::UnitZ(), truth.conjugate() * Vec3::UnitZ());
}

double rms_after_fit(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.empty()) return 0.0;
  const Pose a_T_b = align_points(a, b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - a_T_b * b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, a.size())));
}

void note_alarms(const TrackState& state, TrackScore& score) {
  for (const TrackAlarm& alarm : state.alarms)
    if (std::ranges::none_of(score.alarms, [&](const TrackScore::Alarm& known) {
          return known.first.kind == alarm.kind && known.first.sensor == alarm.sensor &&
                 known.first.joint == alarm.joint;
        }))
      score.alarms.push_back({alarm, state.time});
}

std::vector<InsRow> rows_of(const TrackingModel& model, const InsRecording& recording) {
  std::vector<std::size_t> column;  // of the recording, for each sensor of the model
  for (const TrackingSensor& sensor : model.sensors)
    column.push_back(static_cast<std::size_t>(std::ranges::find(recording.sensors, sensor.name, &InsSensor::name) -
                                              recording.sensors.begin()));
  const std::vector<double>& time = recording.loggers.front().time;
  std::vector<InsRow> rows(time.size());
  for (std::size_t r = 0; r < time.size(); ++r) {
    rows[r].time = time[r];
    for (const std::size_t c : column) {
      const InsSensor& sensor = recording.sensors[c];
      rows[r].sensors.push_back(sample(sensor, recording.time(sensor), r));
    }
  }
  return rows;
}

/// Calls `add` with the state at each row and whether the filter follows a moving base.
template <class Add>
void each_state(const TrackingModel& model, kinfer::track::Estimator estimator, const std::vector<InsRow>& rows,
                const Add& add) {
  if (estimator == kinfer::track::Estimator::smoother) {
    kinfer::track::smooth(model, {}, rows, [&](const TrackState& state) { add(state, false); });
    return;
  }
  kinfer::track::Tracker tracker(model);
  for (const InsRow& row : rows) {
    tracker.add(row);
    add(tracker.state(), tracker.filter().state().base == kinfer::track::BaseMode::moving);
  }
}

}  // namespace

TrackScore track(const TrackingModel& model, const SimulatedDrive* identified, const SimulatedDrive& drive,
                 const Judgement& judgement) {
  using Clock = std::chrono::steady_clock;
  kinfer::track::ComposedFilters composed(model, {});
  const std::vector<TrueJoint> truth = true_joints(model, identified, drive.machine);
  const std::size_t
      base = sensor_named(drive.machine, model.sensors[static_cast<std::size_t>(model.bodies[0].sensor)].name),
      tip = sensor_named(
          drive.machine,
          model.sensors[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(model.tool.body)].sensor)].name);
  TrackScore score;
  score.joints.resize(truth.size());
  std::vector<Sum> sums(truth.size());
  std::vector<Vec3> tool, true_tool;
  double tilt = 0.0, stated_tilt = 0.0, spent = 0.0;
  int rows = 0;
  const std::vector<InsRow> log = rows_of(model, drive.recording);
  std::size_t r = 0;
  auto before = Clock::now();
  const auto judge = [&](const TrackState& state, bool base_moves) {
    composed.add(log[r]);
    note_alarms(state, score);
    for (const double x : state.innovation)
      if (state.started && !std::isnan(x)) score.largest_innovation = std::max(score.largest_innovation, x);
    if (!state.started || state.time - log.front().time < judgement.from) return;
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const auto at = static_cast<Index>(j);
      const double q = truth[j].sign * (drive.motion.q(truth[j].row, static_cast<Index>(r)) - truth[j].zero);
      const bool is_relative = state.joints[j].reference == JointReference::start;
      Sum& sum = sums[j];
      if (std::isnan(state.q[at])) continue;
      if (sum.rows == 0 && is_relative) sum.start = state.q[at] - q;
      if (!is_relative && score.joints[j].is_first && score.joints[j].observable_at <= 0.0)
        score.joints[j].observable_at = state.time;
      score.joints[j].is_first |= is_relative;
      const double apart = state.q[at] - q - (is_relative ? sum.start : 0.0);
      // What is measured on the segments is the same after a whole turn.
      const bool turns = model.bodies[j + 1].motion != TrackingMotion::prismatic;
      const double e = turns && !is_relative ? wrap_to_pi(apart) : apart;
      sum.squares += e * e;
      const double sd = std::max(state.sd_q[at], 1e-6);
      sum.stated += sd * sd;
      sum.nees += e * e / (sd * sd);
      sum.inside += std::abs(e) <= 1.96 * sd;
      ++sum.rows;
      const double other = composed.state().q[at] - q;
      if (std::isnan(other)) continue;
      if (sum.composed_rows == 0 && is_relative) sum.composed_start = other;
      sum.composed += (other - sum.composed_start) * (other - sum.composed_start);
      ++sum.composed_rows;
    }
    const SensorMotion &below = drive.motion.sensors[base], &above = drive.motion.sensors[tip];
    const bool waits = base_moves && std::ranges::any_of(state.joints, [](const JointStatus& joint) {
                         return joint.reference == JointReference::start;
                       });
    if (waits) return;
    ++rows;
    const double tilted = tilt_error(state.world_q_base, below.world_R_sensor[r]);
    tilt += tilted * tilted;
    stated_tilt += square(state.sd_base[0]) + square(state.sd_base[1]);
    if (r % 10 != 0 || state.base_T_tool.position.hasNaN()) return;
    tool.push_back(state.base_T_tool.position);
    true_tool.push_back(below.world_R_sensor[r].conjugate() * Vec3(above.position[r] - below.position[r]));
  };
  each_state(model, judgement.estimator, log, [&](const TrackState& state, bool base_moves) {
    spent += std::chrono::duration<double>(Clock::now() - before).count();
    judge(state, base_moves);
    ++r;
    before = Clock::now();
  });
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const Sum& sum = sums[j];
    JointScore& joint = score.joints[j];
    const double n = std::max(1, sum.rows);
    joint.rms = std::sqrt(sum.squares / n);
    joint.composed_rms = std::sqrt(sum.composed / std::max(1, sum.composed_rows));
    joint.stated = std::sqrt(sum.stated / n);
    joint.nees = sum.nees / n;
    joint.coverage = sum.inside / n;
    joint.is_prismatic = model.bodies[j + 1].motion == TrackingMotion::prismatic;
  }
  score.tool_rms = rms_after_fit(true_tool, tool);
  score.base_tilt_rms = std::sqrt(tilt / std::max(1, rows));
  score.stated_base_tilt = std::sqrt(stated_tilt / std::max(1, rows));
  score.cpu_per_row = spent / static_cast<double>(log.size());
  return score;
}

}  // namespace kinfer::study::track_study
