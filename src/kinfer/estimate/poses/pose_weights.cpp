// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_weights.hpp"

namespace kinfer {

Weights weights_of(const PoseSet& data, const Instrument& instrument) {
  Weights weights;
  for (const ResidualKind& kind : residual_kinds())
    for (std::size_t i = 0; i < kind.count(data); ++i)
      weights.of(kind.kind).push_back(kind.specified_sd(data, i, instrument).cwiseMax(noise_free_sd));
  weights.couplings = couplings_of(data, weights.of<PointMeasurement>(), weights.of<OrientationMeasurement>());
  return weights;
}

std::vector<Block> blocks_of(const PoseSet& data) {
  std::vector<Block> blocks;
  for (const ResidualKind& kind : residual_kinds())
    for (std::size_t i = 0; i < kind.count(data); ++i)
      blocks.push_back({kind.kind, static_cast<int>(i), kind.row(data, i), kind.size});
  return blocks;
}

PoseSet keep_measurements(const PoseSet& data, const std::vector<bool>& kept) {
  PoseSet result = data;
  auto next = kept.begin();
  for (const ResidualKind& kind : residual_kinds()) {
    const auto count = static_cast<std::ptrdiff_t>(kind.count(data));
    kind.keep(result, {next, next + count});
    next += count;
  }
  return result;
}

}  // namespace kinfer
