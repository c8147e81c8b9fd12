// SPDX-License-Identifier: Apache-2.0
// A tracked drive beside its truth: errors of joints and tool, honesty of the standard deviations, alarms, time.
#pragma once

#include "studies/track/drives.hpp"

namespace kinfer::study::track_study {

struct JointScore {
  double rms = 0.0, composed_rms = 0.0;  ///< [rad] or [m]
  double stated = 0.0;                   ///< [rad] or [m] root mean square of the stated standard deviations
  double nees = 0.0, coverage = 0.0;     ///< mean of (error/sd)²; share of errors within 1.96 sd
  bool is_first = false;                 ///< vertical axis on a level base: counts from the start
  bool is_prismatic = false;
  double observable_at = 0.0;  ///< [s] when a position that counted from the start became observable
};

struct TrackScore {
  std::vector<JointScore> joints;
  double tool_rms = 0.0;            ///< [m] after a rigid fit of the path
  double base_tilt_rms = 0.0;       ///< [rad]
  double stated_base_tilt = 0.0;    ///< [rad] root mean square of what the standard deviations let expect
  double cpu_per_row = 0.0;         ///< [s]
  double largest_innovation = 0.0;  ///< of any sensor, T over its expectation averaged over some rows
  struct Alarm {
    TrackAlarm first;
    double at = 0.0;  ///< [s]
  };
  std::vector<Alarm> alarms;  ///< each kind and sensor once
};

struct Judgement {
  kinfer::track::Estimator estimator = kinfer::track::Estimator::filter;
  double from = 0.0;  ///< [s] of the drive: errors before it do not count
};

/// `identified`: the drive at whose beginning the model's joint positions are zero; null: they are the machine's own.
TrackScore track(const TrackingModel& model, const SimulatedDrive* identified, const SimulatedDrive& drive,
                 const Judgement& judgement = {});

}  // namespace kinfer::study::track_study
