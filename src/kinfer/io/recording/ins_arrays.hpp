// SPDX-License-Identifier: Apache-2.0
// INS recordings from columns in memory.
#pragma once

#include <span>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// One sensor; every triad is n x 3, row by row, NaN where a sample is missing.
struct InsArrays {
  std::string sensor;
  std::span<const double> time;              ///< [s], n, strictly increasing
  std::span<const double> acceleration;      ///< [m/s²] specific force
  std::span<const double> angular_velocity;  ///< [rad/s]
  std::span<const double> field{};           ///< [µT]; empty: no magnetometer
};

/// Adds the sensor. Sensors with the same instants share a logger, and so a clock. Samples are screened as those of a
/// file; an error where the time does not increase, or where values are impossible in their units.
Result<void> append_ins_arrays(const InsArrays& arrays, InsRecording& recording);

}  // namespace kinfer
