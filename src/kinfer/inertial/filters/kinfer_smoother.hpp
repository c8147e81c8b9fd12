// SPDX-License-Identifier: Apache-2.0
// Offline version of kinfer's orientation filter: a forward pass and Rauch-Tung-Striebel smoothing, so that each
// orientation uses the measurements before and after it.
#pragma once

#include <span>
#include <vector>

#include "kinfer/inertial/filters/kinfer_filter.hpp"

namespace kinfer {

struct KinferOfflineOptions {
  KinferFilterOptions filter{.update_period =
                                 0.1};  ///< of the forward pass; the period determines the memory: 70 MB per hour
};

/// Smoothed orientations and gyro errors.
struct SmoothedOrientation {
  std::vector<Quat> world_q_sensor;  ///< one per row
  std::vector<double> update_time;   ///< [s] of each update
  std::vector<Vec3> bias;            ///< [rad/s] of the gyro, at each update
  Mat3 scale = Mat3::Zero();         ///< of the gyro: true rate = (1 + scale) (rate - bias)
};
SmoothedOrientation smooth_orientation(const InsSensor& sensor, std::span<const double> time,
                                       const KinferOfflineOptions& options = {});

}  // namespace kinfer
