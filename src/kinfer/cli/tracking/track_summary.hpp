// SPDX-License-Identifier: Apache-2.0
// Summary printed by `kinfer track`.
#pragma once

#include <string>

#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer::cli {

/// Verdict, range and standard deviation of each joint position, alarms, remarks.
std::string track_summary(const TrackRun& run);

}  // namespace kinfer::cli
