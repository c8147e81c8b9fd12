// SPDX-License-Identifier: Apache-2.0
// Drives of a simulated machine that was changed in between.
#pragma once

#include <string>

#include "kinfer/simulate/ground_truth.hpp"
#include "kinfer/simulate/ins_recording.hpp"

namespace kinfer::study::update_study {

struct UpdateSetup {
  std::string machine = "excavator-general", grade = "industrial";
  std::uint64_t machine_seed = 1;
  int drive = 0;            ///< 0: the first; the others are driven otherwise, by the same sensors
  std::string moved_pin{};  ///< body of the machine's file whose joint is elsewhere on its parent; empty: none
  double moved_by = 0.0;    ///< [m] along the parent's x axis
};

struct UpdateDrive {
  InsRecording recording;
  MachineTruth truth;
};

/// The same machine_seed gives the same machine and individual sensors; noise and slow biases go on from one drive to
/// the next.
UpdateDrive update_drive(const UpdateSetup& setup);

/// As if the sensor sat on its segment turned by an angle [rad].
void turn_sensor(InsRecording& recording, std::size_t sensor, double angle);

}  // namespace kinfer::study::update_study
