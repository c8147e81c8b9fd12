// SPDX-License-Identifier: Apache-2.0
// Simulated INS recordings: the true motion with the noise, biases, scale errors, range and resolution of a sensor
// model, and optionally faults as in the field: lost samples, spikes, magnetic disturbances and iron.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// Faults beyond the instruments' own errors.
struct SensorFaults {
  double missing = 0.0;               ///< fraction of rows that a sensor loses, in runs of 5 on average
  double spikes = 0.0;                ///< single-sample spikes per minute, on each axis of accelerometer and gyro
  double magnetic_disturbance = 0.0;  ///< [µT] rms per axis of the field of steel moving nearby (2 s time constant)
  double hard_iron = 0.0;             ///< [µT] constant field of iron on each sensor's segment, beyond the grade's
  double soft_iron = 0.0;             ///< standard deviation of the elements of a symmetric soft iron matrix, likewise
  double magnetic_transients = 0.0;  ///< [µT] peak of steel passing by two of the sensors, for a few seconds each time
  bool has_magnetometer = true;
};

/// The recording of a motion by sensors of this model, each with errors of its own. Faults are flagged as a reader of
/// the file would flag them. Another `drive` (1, 2, ...) is recorded by the same sensors with other noise.
InsRecording simulate_recording(const Machine& machine, const MachineMotion& motion, const SensorModel& model,
                                const SensorFaults& sensor_faults, const Rng& rng, std::uint64_t drive = 1);

}  // namespace kinfer
