// SPDX-License-Identifier: Apache-2.0
// Unit, sense and axes of each gyroscope against the accelerometer and the magnetometer of the same sensor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// An error if the gyroscope's columns hold Euler angles.
Result<void> refuse_attitudes(const InsRecording& recording);

/// The unit of the rates is one for the log, unless sensors contradict each other. Other axes are mapped to those of
/// the accelerometer: any axes that the instruments share are as good, since mountings are unknown.
void mend_axes(MendedLog& log, int threads);

/// Of these sensors, which share no joint with any other by the axes of the file, the one whose axes the neighbours
/// most clearly want otherwise, and the finding about it; none where they do not.
struct WantedAxes {
  std::string sensor;
  Mat3 axes = Mat3::Identity();  ///< of the instrument
  bool is_of_gyroscope = true;   ///< otherwise the accelerometer's; only a magnetometer tells
  Finding finding;
};
std::optional<WantedAxes> axes_wanted_by_neighbours(const InsRecording& recording,
                                                    const std::vector<std::size_t>& unconnected, int threads);

/// The sensor takes the axes.
void map_axes(InsRecording& recording, const WantedAxes& wanted);

/// "x, -z, y": row by row of a permutation with signs.
std::string describe_axes(const Mat3& axes);

}  // namespace kinfer::identify
