// SPDX-License-Identifier: Apache-2.0
// Files of a simulated recording (docs/formats.md): imu.csv, motion.csv, truth.json. Deterministic to the byte.
#pragma once

#include <string>

#include "kinfer/measurement/ins/ins_recording.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::cli {

/// Columns t and <sensor>_ax .. <sensor>_mz; an empty cell is a lost sample. One logger.
std::string imu_csv(const InsRecording& recording);

/// Columns t, q_<joint> [rad] or [m], <sensor>_qw .. <sensor>_qz (sensor to world).
std::string motion_csv(const Machine& machine, const MachineMotion& motion);

/// Settings of a simulation, recorded in truth.json beside the truth.
struct SimulationRecord {
  std::string machine, grade, base;
  double slope_deg = 0.0;
  std::uint64_t seed = 1;
  int drive = 1;
  double sampling_rate = 200.0;  ///< [Hz]
};
std::string truth_json(const SimulationRecord& record, const Drive& drive, const Machine& machine,
                       const MachineTruth& truth);

}  // namespace kinfer::cli
