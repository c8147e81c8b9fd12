// SPDX-License-Identifier: Apache-2.0
// Faults that the user requests in a simulated log.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer::cli {

struct SimulatedFaults {
  std::string late;     ///< "ins2=50": its measurements are logged 50 ms late
  std::string remount;  ///< "ins3=30": rotated by 21 degrees and shifted by 10 cm on its segment after 30 s
  double jitter = 0.0;  ///< [ms] rms scatter of the time stamps
  int packet = 1;       ///< rows that are stamped at once
  double foam = 0.0;    ///< [deg] tilt of sensors on foam mounts when mounted sideways; 0: rigid mounts
};

Result<MachineMotion> with_remount(const Machine& machine, MachineMotion motion, const SimulatedFaults& faults);
Result<InsRecording> with_late_sensor(InsRecording recording, const SimulatedFaults& faults);
InsRecording with_stamp_faults(InsRecording recording, const SimulatedFaults& faults, const Rng& rng);

}  // namespace kinfer::cli
