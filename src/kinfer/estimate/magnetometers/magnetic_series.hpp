// SPDX-License-Identifier: Apache-2.0
// What the magnetometers of a machine measured, on one slow clock, beside the orientations of their bodies as a
// continuous-time fit of gyroscopes and accelerometers found them.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// One magnetometer; one entry per bin of the clock.
struct MagneticSeries {
  std::size_t sensor = 0;           ///< index into the recording
  std::vector<std::size_t> path;    ///< bodies from the root's child to the sensor's own; empty: it is on the root
  std::vector<Vec3> field;          ///< mean of the bin, in the sensor's frame
  std::vector<bool> is_valid;       ///< whether the bin has measurements
  std::vector<Mat3> root_R_sensor;  ///< at the middle of the bin
};

struct MagneticRecording {
  std::vector<MagneticSeries> sensors{};         ///< those with a magnetometer
  std::vector<std::vector<Mat3>> root_R_body{};  ///< of every body, one per bin
  double strength = 0.0;                         ///< median norm of the field over all sensors
  std::size_t bins = 0;
};

/// Bins of 0.1 s, longer ones in recordings of more than ten minutes. `x`: a fit whose root is at rest. Sensors are in
/// the order of the problem.
MagneticRecording magnetic_recording(const InsRecording& recording, const InsProblem& problem, const InsLayout& layout,
                                     const InsUnknowns& x);

}  // namespace kinfer
