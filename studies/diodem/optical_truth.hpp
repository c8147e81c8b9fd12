// SPDX-License-Identifier: Apache-2.0
// The real chain of five segments as cameras saw it: hinge axes in the frames of the INS on the segments.
#pragma once

#include <map>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer::study {

/// Orientations of the segments, gaps left out.
struct OpticalLog {
  std::vector<double> time;                          ///< [s] by the cameras' clock
  std::map<std::string, std::vector<Mat3>> segment;  ///< world_R_segment, one a time; NaN in gaps
};
Result<OpticalLog> read_optical(const std::string& path, const std::vector<std::string>& segments);

/// How the cameras' frames and clock lie against those of the INS.
struct OpticalAlignment {
  double late = 0.0;                     ///< [s] to add to the cameras' times
  std::map<std::string, Mat3> rotation;  ///< INS_R_segment
  std::map<std::string, double> rms;     ///< [rad/s] of the rates that differ
};

/// One constant rotation a segment and one offset of time: turns between camera pictures against the gyros' integral.
OpticalAlignment aligned(const OpticalLog& optical, const InsRecording& recording);

struct OpticalHinge {
  Vec3 in_parent, in_child;     ///< axes in the frames of the INS
  double axis_deviation = 0.0;  ///< [rad] rms angle between them
};
OpticalHinge optical_hinge(const OpticalLog& optical, const OpticalAlignment& alignment, const std::string& parent,
                           const std::string& child);

}  // namespace kinfer::study
