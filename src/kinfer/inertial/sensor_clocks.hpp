// SPDX-License-Identifier: Apache-2.0
// Clock offsets between the sensors of one machine from their angular rates alone, without orientation or tree.
//
// Across a revolute joint both sensors measure the same rate perpendicular to its axis: with j the axis in each sensor,
// |ω|² − (ω·j)² agrees (Seel, Schauer and Raisch 2012). So for neighbouring sensors some quadratic form of one rate
// equals some quadratic form of the other at the same time, for any mounting. The clock offset is the lag that
// maximises the largest canonical correlation (Hotelling 1936) of the two sets of six products ω_i ω_k. Offsets are
// accumulated along the maximum spanning tree of the sensors under this measure.
#pragma once

#include <span>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/clock_correction.hpp"

namespace kinfer {

struct ClockEstimate {
  ClockCorrection correction;  ///< to the reference clock
  bool known = false;          ///< false: it never moves, or its motion correlates with no other sensor
};

struct ClockOptions {
  double sampling_rate = 50.0;        ///< [Hz] sampling rate of the comparison
  double max_offset = 0.5;            ///< [s] between sensors, after the loggers have been aligned
  double window = 60.0;               ///< [s] of one comparison; longer recordings use several, for the drift
  double min_drift_duration = 180.0;  ///< [s] no drift is estimated from shorter recordings
};

/// One per sensor. Loggers may start at any time. The reference is the sensor of the first logger that agrees best with
/// the others, or the best of all where none of it does; its drift is that of the clock that most agree on.
std::vector<ClockEstimate> estimate_sensor_clocks(const InsRecording& recording, const ClockOptions& options = {},
                                                  int threads = 0);

/// [s/s] That of most clocks where they agree with each other and not with the reference, whose drift is 0; else 0. A
/// clock that runs fast makes the machine larger, so the odd one must not be the reference.
double common_drift(std::span<const ClockCorrection> corrections);

/// The correction to a machine time that runs slower by `drift` and is the same at `middle`.
ClockCorrection without_drift(const ClockCorrection& correction, double drift, double middle);

}  // namespace kinfer
