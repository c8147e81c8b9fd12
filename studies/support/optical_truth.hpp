// SPDX-License-Identifier: Apache-2.0
// Optical reference of a chain of five segments: revolute axes in the frames of the INS on the segments.
#pragma once

#include <map>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::study {

/// Orientations of the segments over time.
struct OpticalLog {
  std::vector<double> time;                          ///< [s] of the cameras' clock
  std::map<std::string, std::vector<Mat3>> segment;  ///< world_R_segment at each time; NaN in gaps
};
Result<OpticalLog> read_optical(const std::string& path, const std::vector<std::string>& segments);

/// The cameras' frames and clock relative to those of the INS.
struct OpticalAlignment {
  double late = 0.0;                     ///< [s] to add to the cameras' times
  std::map<std::string, Mat3> rotation;  ///< INS_R_segment
  std::map<std::string, double> rms;     ///< [rad/s] difference of angular velocities
};

/// One constant rotation a segment and one time offset: rotations between camera frames against the gyros' integral.
OpticalAlignment aligned(const OpticalLog& optical, const InsRecording& recording);

struct OpticalJoint {
  Vec3 in_parent, in_child;     ///< axes in the frames of the INS
  double axis_deviation = 0.0;  ///< [rad] rms angle between them
};
OpticalJoint optical_joint(const OpticalLog& optical, const OpticalAlignment& alignment, const std::string& parent,
                           const std::string& child);

}  // namespace kinfer::study
