// SPDX-License-Identifier: Apache-2.0
// Standard deviations of the measurements of a pose set, and the blocks of residuals that they weight.
#pragma once

#include <vector>

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"
#include "kinfer/estimate/poses/pose_coupling.hpp"

namespace kinfer {

/// [m], [rad] Lower bound of a standard deviation (1e-6 mm); 0 means noise-free.
inline constexpr double noise_free_sd = 1e-9;

/// Standard deviations of the measurements, one per entry of the pose set's lists.
struct Weights {
  std::vector<Vec3> point_sd;                                    ///< [m] per axis
  std::vector<Vec3> orientation_sd;                              ///< [rad] about the world's axes
  std::vector<Vec3> contact_sd, distance_sd, pair_sd, plane_sd;  ///< [m]; one-row kinds use the first only
  std::vector<Vec3> tilt_sd;                                     ///< [m/s²]; the first two are used
  std::vector<PoseCoupling> couplings;  ///< of orientations with the points of their rows, ascending; often empty

  std::vector<Vec3>& of(MeasurementKind kind);
  const std::vector<Vec3>& of(MeasurementKind kind) const;
};

/// From the instrument's specification, or a row's own standard deviation if the file gives it. A lower bound keeps the
/// weights of noise-free data finite.
Weights weights_of(const PoseSet& data, const Instrument& instrument);

/// One block of rows: the list and entry that it comes from.
struct Block {
  MeasurementKind kind = MeasurementKind::point;
  int index = 0;  ///< into the pose set's list of that kind
  int row = 0;    ///< pose
  int size = 3;   ///< rows
};
std::vector<Block> blocks_of(const PoseSet& data);

/// The pose set with only the measurements that are kept, one flag per block of blocks_of.
PoseSet keep_measurements(const PoseSet& data, const std::vector<bool>& kept);

}  // namespace kinfer
