// SPDX-License-Identifier: Apache-2.0
// Drawings of a run, as SVG; empty where there is nothing to draw.
#pragma once

#include <string>

#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer::report {

/// Joint positions over time, each with its 95 % band.
std::string position_drawings(const TrackRun& run);

/// The tool's path in space, seen from the front left.
std::string tool_path_drawing(const TrackRun& run);

/// The sensors' innovations over time, logarithmic; 1 is as expected.
std::string innovation_drawing(const TrackRun& run);

/// One bar for each alarm, from its beginning to its end.
std::string alarm_drawing(const TrackRun& run);

}  // namespace kinfer::report
