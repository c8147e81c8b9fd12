// SPDX-License-Identifier: Apache-2.0
// Faults of real logs, injected into simulated ones.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// A sensor with a deviating clock: what happens at t is logged at t + offset + drift (t − middle).
struct ClockFault {
  std::size_t sensor = 0;
  double offset = 0.0;  ///< [s] at the middle of the recording; positive: logged late
  double drift = 0.0;   ///< [s/s]
};

/// Moves the sensor to a logger of its own with such a clock.
InsRecording with_clock_fault(const InsRecording& recording, const ClockFault& fault);

/// Delays the samples of the sensor by `rows` rows of its logger; the first ones are missing.
InsRecording with_delayed_rows(const InsRecording& recording, std::size_t sensor, std::size_t rows);

/// The rows of all loggers are stamped late by a random time: half-normal delays with an rms scatter of `jitter` [s]
/// about their mean, or as late as needed to stay in order. The samples are as before.
InsRecording with_stamp_jitter(const InsRecording& recording, double jitter, Rng rng);

/// `rows` rows at a time are stamped when the last of them arrives, a microsecond apart.
InsRecording with_packets(const InsRecording& recording, std::size_t rows);

/// A sensor that is remounted at another pose on its segment from row `row` on; old_T_new of its frame.
MachineMotion with_remount(MachineMotion motion, std::size_t sensor, std::size_t row, const Pose& old_T_new);

/// Merges two recordings of the same rate row by row; sensor names of `other` get the prefix.
InsRecording merge_recordings(const InsRecording& one, const InsRecording& other, const std::string& prefix);

}  // namespace kinfer
