// SPDX-License-Identifier: Apache-2.0
// Simulated machines tracked with their true geometry, and what came of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/track/tracker.hpp"
#include "support/tracked_machine.hpp"

namespace kinfer::track {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

struct Case {
  test::SimulatedDrive drive;
  TrackingModel model;
};

inline Case make_case(const test::DriveSetup& setup) {
  Case made{test::simulated_drive(setup), {}};
  made.model = test::tracking_model_of(made.drive.machine, *sensor_grade(setup.grade), setup.sampling_rate);
  made.model.base.moved = setup.base != Base::still;
  return made;
}

inline const Case& still_excavator() {
  static const Case made = make_case({.duration = 40.0});
  return made;
}

struct Outcome {
  Tracker tracker;
  VectorXd squares, first, largest_sd;
  VectorXd largest_late_sd;  // after 10 s
  std::vector<bool> is_relative;
  int rows = 0;
  std::vector<TrackAlarm> alarms{};  // each kind and sensor once, with the time at which it was raised
  std::vector<double> raised{};

  double rms(int joint) const { return std::sqrt(squares[joint] / rows); }
};

inline void turn_sensor(InsSample& sample, const Mat3& turn) {
  sample.acceleration = turn * sample.acceleration;
  sample.angular_velocity = turn * sample.angular_velocity;
}

struct Pause {
  double begin = 0.0, end = 0.0;  // [s]
};

/// Without the rows before `begin` and in the pause.
template <class Change>
Outcome run(const Case& given, const TrackOptions& options, Change change, double begin = 0.0, Pause pause = {}) {
  const int joints = given.model.positions();
  Outcome out{.tracker = Tracker(given.model, options),
              .squares = VectorXd::Zero(joints),
              .first = VectorXd::Constant(joints, no_value),
              .largest_sd = VectorXd::Zero(joints),
              .largest_late_sd = VectorXd::Zero(joints),
              .is_relative = std::vector<bool>(static_cast<std::size_t>(joints), false)};
  InsRow row;
  for (std::size_t r = 0; r < given.drive.recording.loggers.front().time.size(); ++r) {
    test::fill_row(given.drive.recording, r, row);
    if (row.time < begin || (row.time > pause.begin && row.time < pause.end)) continue;
    change(row);
    out.tracker.add(row);
    const TrackState& state = out.tracker.state();
    for (const TrackAlarm& alarm : state.alarms)
      if (std::ranges::none_of(out.alarms, [&](const TrackAlarm& known) {
            return known.kind == alarm.kind && known.sensor == alarm.sensor && known.joint == alarm.joint;
          }))
        out.alarms.push_back(alarm), out.raised.push_back(row.time);
    if (!state.started) continue;
    ++out.rows;
    out.largest_sd = out.largest_sd.cwiseMax(state.sd_q);
    if (row.time > 10.0) out.largest_late_sd = out.largest_late_sd.cwiseMax(state.sd_q);
    for (int j = 0; j < joints; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      out.is_relative[joint] = state.joints[joint].reference == JointReference::start;
      const double e = state.q[j] - given.drive.q(j, r);
      if (std::isnan(out.first[j])) out.first[j] = out.is_relative[joint] ? e : 0.0;
      out.squares[j] += (e - out.first[j]) * (e - out.first[j]);
    }
  }
  return out;
}

inline const auto unchanged = [](InsRow&) {};

inline const Case& quick_arm() {
  static const Case made = make_case({.machine = "robot6", .script = Script::quick, .duration = 40.0});
  return made;
}

}  // namespace kinfer::track
