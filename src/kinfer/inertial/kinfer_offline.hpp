// The house's filter made acausal: a forward pass, then Rauch-Tung-Striebel smoothing of its beliefs, so that each
// row's orientation rests on what came before and after it.
#pragma once

#include <span>
#include <vector>

#include "kinfer/inertial/kinfer_filter.hpp"

namespace kinfer {

struct KinferOfflineOptions {
  KinferFilterOptions filter{.update_period =
                                 0.1};  ///< of the forward pass; the period rules the memory: 70 MB an hour
};

/// What the smoother found beside the orientations.
struct SmoothedMotion {
  std::vector<Quat> world_q_sensor;  ///< one a row
  std::vector<double> update_time;   ///< [s] of each update
  std::vector<Vec3> bias;            ///< [rad/s] of the gyro, at each update
  Mat3 scale = Mat3::Zero();         ///< of the gyro: true rate = (1 + scale) (rate - bias)
};
SmoothedMotion smoothed_motion(const InsSensor& sensor, std::span<const double> time,
                               const KinferOfflineOptions& options = {});

}  // namespace kinfer
