// SPDX-License-Identifier: Apache-2.0
// What is done with every recording after its file is read, whatever its format: faults flagged, units checked, and
// what the user should know put into words.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// Marks faults and adds remarks for the sensors from `first` on; an error where values are impossible in their unit.
/// `field_has_unit`: one per sensor from `first` on.
Result<void> screen_sensors(InsRecording& recording, std::size_t first, const std::string& file,
                            const std::vector<bool>& field_has_unit);

/// Remarks on gaps in the time of a logger, and on a single row.
void add_time_remarks(InsRecording& recording, std::size_t logger, const std::string& file);

}  // namespace kinfer
