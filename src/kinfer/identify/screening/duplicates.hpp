// SPDX-License-Identifier: Apache-2.0
// Sensors that hold the same measurements: one file given twice, or one sensor recorded under two names.
#pragma once

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::identify {

/// One finding for each of the `sensors` (indices) whose specific forces and angular velocities equal those of an
/// earlier one in nearly all rows. Two instruments on one segment never do: their noise differs.
std::vector<Finding> duplicate_findings(const InsRecording& recording, const std::vector<std::size_t>& sensors);

}  // namespace kinfer::identify
