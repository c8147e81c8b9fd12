// SPDX-License-Identifier: Apache-2.0
// Standard deviations of the measurements of a pose set, and the blocks of residuals that they weight.
#pragma once

#include <array>
#include <vector>

#include "kinfer/estimate/poses/instruments/residual_kind.hpp"
#include "kinfer/estimate/poses/pose_coupling.hpp"

namespace kinfer {

/// [m], [rad] Lower bound of a standard deviation (1e-6 mm); 0 means noise-free.
inline constexpr double noise_free_sd = 1e-9;

/// Standard deviations of the measurements, one per entry of the pose set's lists.
struct Weights {
  /// [m], [rad] or [m/s²] for each kind; the first `rows` of each are used: points and orientations along their axes.
  std::array<std::vector<Vec3>, measurement_kinds> sd;
  std::vector<PoseCoupling> couplings;  ///< of orientations with the points of their rows, ascending; often empty

  std::vector<Vec3>& of(MeasurementKind kind) { return sd[index(kind)]; }
  const std::vector<Vec3>& of(MeasurementKind kind) const { return sd[index(kind)]; }
  template <class M>
  std::vector<Vec3>& of() {
    return of(kind_of<M>);
  }
  template <class M>
  const std::vector<Vec3>& of() const {
    return of(kind_of<M>);
  }
};

/// From the instrument's specification, or a row's own standard deviation if the file gives it. A lower bound keeps the
/// weights of noise-free data finite.
Weights weights_of(const PoseSet& data, const Instrument& instrument);

/// One block of rows: the list and entry that it comes from.
struct Block {
  MeasurementKind kind = kind_of<PointMeasurement>;
  int index = 0;  ///< into the pose set's list of that kind
  int row = 0;    ///< pose
  int size = 3;   ///< rows
};
std::vector<Block> blocks_of(const PoseSet& data);

/// The pose set with only the measurements that are kept, one flag per block of blocks_of.
PoseSet keep_measurements(const PoseSet& data, const std::vector<bool>& kept);

}  // namespace kinfer
