// How far the clocks of the sensors of one machine are apart, from their rates alone: no orientation, no tree.
//
// Across a hinge both sensors see the same rate off its axis: with j the axis in each sensor, |ω|² − (ω·j)² agrees
// (Seel, Schauer and Raisch 2012). So for neighbours some quadratic form of the one rate equals some quadratic form of
// the other at equal times, for any mounting. The lag at which the largest canonical correlation (Hotelling 1936) of
// the two sets of six products ω_i ω_k is largest is the clocks' difference; sensors that are linked strongest in this
// sense are compared, and differences add up along the maximum spanning tree.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/clocks.hpp"

namespace kinfer {

struct ClockEstimate {
  ClockCorrection correction;  ///< to the clock of the reference
  bool known = false;          ///< false: it never moves, or moves unlike every other sensor
};

struct ClockOptions {
  double rate = 50.0;               ///< [Hz] of the comparison
  double largest_offset = 0.5;      ///< [s] between sensors, once loggers are aligned as wholes
  double window = 60.0;             ///< [s] of one comparison; longer recordings are compared in several, for the drift
  double least_drift_span = 180.0;  ///< [s] shorter recordings tell no drift here
};

/// One a sensor. Loggers may start at any time. The reference is the sensor of the first logger that agrees best with
/// the others.
std::vector<ClockEstimate> sensor_clocks(const InsRecording& recording, const ClockOptions& options = {},
                                         int threads = 0);

}  // namespace kinfer
