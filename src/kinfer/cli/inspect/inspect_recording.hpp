// SPDX-License-Identifier: Apache-2.0
// `kinfer inspect` for INS recordings.
#pragma once

#include <string>
#include <vector>

namespace kinfer::cli {

enum class AllanPlot { none, print };
enum class InspectOutput { text, json };

struct RecordingChoice {
  std::vector<std::string> paths;
  std::string columns;              ///< column map; empty: none
  std::vector<std::string> topics;  ///< of robot logs; empty: all Imu topics
};

/// Prints a description of the recording: sensors, sampling rates, gaps, faults, rests, noise and bias, which sensors
/// move when, estimated grade; with `AllanPlot::print` also the Allan deviation over the longest rest. Returns the exit
/// code.
int inspect_recording(const RecordingChoice& choice, AllanPlot allan, InspectOutput output);

}  // namespace kinfer::cli
