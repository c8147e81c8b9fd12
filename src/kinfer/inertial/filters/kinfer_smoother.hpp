// SPDX-License-Identifier: Apache-2.0
// Offline version of kinfer's orientation filter: a forward pass and Rauch-Tung-Striebel smoothing, so that each
// orientation uses the measurements before and after it.
#pragma once

#include <span>

#include "kinfer/inertial/filters/filter_output.hpp"
#include "kinfer/inertial/filters/kinfer_filter.hpp"

namespace kinfer {

struct KinferOfflineOptions {
  KinferFilterOptions filter{.update_period =
                                 0.1};  ///< of the forward pass; the period determines the memory: 70 MB per hour
};

/// Smoothed orientations, and the gyro errors with the bias at each update.
FilterOutput smooth_orientation(const InsSensor& sensor, std::span<const double> time,
                                const KinferOfflineOptions& options = {});

}  // namespace kinfer
