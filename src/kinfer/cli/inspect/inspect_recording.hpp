// SPDX-License-Identifier: Apache-2.0
// `kinfer inspect` for INS recordings.
#pragma once

#include <string>
#include <vector>

namespace kinfer::cli {

enum class AllanPlot { none, print };

/// Prints a description of the recording: sensors, sampling rates, gaps, faults, rests, noise and bias, which sensors
/// move when, estimated grade; with `AllanPlot::print` also the Allan deviation over the longest rest. Returns the exit
/// code.
int inspect_recording(const std::vector<std::string>& paths, const std::string& columns, AllanPlot allan);

}  // namespace kinfer::cli
