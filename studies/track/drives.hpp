// SPDX-License-Identifier: Apache-2.0
// Simulated machines that are identified on one drive and tracked on another, with the truth of both.
#pragma once

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/machine_motion.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::study::track_study {

struct DriveSetup {
  std::string machine = "excavator-general", grade = "industrial";
  Base base = Base::still;
  Script script = Script::standard;
  double duration = 0.0;  ///< [s]; 0: the script's own
  std::uint64_t machine_seed = 1, drive_seed = 1;
  double steel = 0.0;          ///< [µT] of moving steel
  bool known_sensors = false;  ///< without biases and scale errors: they are known, but for their instability
};

struct SimulatedDrive {
  Machine machine;
  MachineMotion motion;
  InsRecording recording;
};

/// The same machine_seed gives the same machine and individual sensors.
SimulatedDrive simulate_drive(const DriveSetup& setup);

/// By default options; its joint positions count from the beginning of the drive.
Result<TrackingModel> identify_drive(const SimulatedDrive& drive);

/// The chain as built, and sensors without biases and scale errors: what any identification could hand over at best.
/// Joint positions are the machine's own.
TrackingModel exact_model(const SimulatedDrive& drive, const std::string& grade);

/// Sensors that were switched off and on again: each bias changed by a random number of this standard deviation, as a
/// share of the grade's.
void change_biases(double share, const std::string& grade, std::uint64_t seed, SimulatedDrive& drive);

/// A change of the recording from `begin` on; play is in the joint before the sensor and moves all beyond it.
enum class FaultKind { none, turned, shifted, play, lost, late };
struct InjectedFault {
  FaultKind kind = FaultKind::none;
  std::size_t sensor = 0;
  double size = 0.0, begin = 0.0, end = 0.0;  ///< [rad], [m] or [s]; [s]
};
void inject(const InjectedFault& fault, SimulatedDrive& drive);

}  // namespace kinfer::study::track_study
