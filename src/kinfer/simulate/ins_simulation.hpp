// What real instruments make of the truth: a sensor model's noise, biases, scales, range and resolution, and on request
// what goes wrong in the field: lost samples, spikes, steel beside the compass.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/measurement/ins_recording.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// What goes wrong beyond the instruments' own errors.
struct SensorTrouble {
  double missing = 0.0;  ///< fraction of the rows that a sensor loses, in runs of 5 on average
  double spikes = 0.0;   ///< wild single samples a minute, on each axis of accelerometer and gyro
  double magnetic_disturbance =
      0.0;  ///< [µT] rms of each axis of the field of steel that moves nearby (2 s time constant)
  bool has_magnetometer = true;
};

/// The recording that sensors of this model make of a motion, each with errors of its own. Faults are marked as a
/// reader of the file would mark them.
InsRecording simulated_recording(const Machine& machine, const MachineMotion& motion, const SensorModel& model,
                                 const SensorTrouble& trouble, Rng rng);

}  // namespace kinfer
