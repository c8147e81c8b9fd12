// SPDX-License-Identifier: Apache-2.0
// How well a fixed set of simulated recordings is identified.
#pragma once

#include <vector>

#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/simulate/ground_truth.hpp"
#include "studies/thresholds/figures.hpp"

namespace kinfer::study::thresholds_study {

struct SimulatedRecording {
  InsRecording recording;
  MachineTruth truth;
  bool rigid_mounts = true;  ///< compliant mounts have no constant frame to compare axis lines in
};

/// Six machines: clean, of consumer grade and moved all at once, on a rocking base without magnetometer, with a linkage
/// in a kinematic loop, on foam mounts, with a sensor that is remounted, with a late sensor.
std::vector<SimulatedRecording> simulated_recordings();

Figures identification_figures(const std::vector<SimulatedRecording>& recordings);

}  // namespace kinfer::study::thresholds_study
