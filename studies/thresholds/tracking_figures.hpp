// SPDX-License-Identifier: Apache-2.0
// What the thresholds of tracking decide: drives of two simulated machines, sound ones and ones with a fault.
#pragma once

#include <vector>

#include "studies/thresholds/figures.hpp"
#include "studies/track/drives.hpp"

namespace kinfer::study::thresholds_study {

struct TrackedDrive {
  track_study::SimulatedDrive identified;
  TrackingModel model;
  track_study::SimulatedDrive drive;
  track_study::InjectedFault fault{};
};

/// Geometry identified from a standard drive by default options.
std::vector<TrackedDrive> tracked_drives();

Figures tracking_figures(const std::vector<TrackedDrive>& drives);

}  // namespace kinfer::study::thresholds_study
