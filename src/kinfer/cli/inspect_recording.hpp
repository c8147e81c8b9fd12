// `kinfer inspect` for INS recordings.
#pragma once

#include <string>
#include <vector>

namespace kinfer::cli {

/// Whether the file's header is that of an INS recording.
bool is_recording(const std::string& path);

enum class AllanPlot { none, print };

/// Prints what was understood of the recording: sensors, rates, gaps, faults, rests, noise and bias, who moves when,
/// the judged grade; with `AllanPlot::print` the Allan deviation of the longest rest too. Returns the program's exit
/// code.
int inspect_recording(const std::vector<std::string>& paths, AllanPlot allan);

}  // namespace kinfer::cli
