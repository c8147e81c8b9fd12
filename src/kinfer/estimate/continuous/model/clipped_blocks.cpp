// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/clipped_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

using Index = Eigen::Index;

struct ClippedSample {
  double place = 0.0;  // in its interval, 0..1
  Vec3 value;
  ClippedSides sides{};
};

/// Rows of an interval's clipped samples; a change of the clipped axes begins a new row.
void put_rows(const std::vector<ClippedSample>& samples, InsBlock& block,
              std::array<ClippedSides, block_nodes>& sides) {
  const std::size_t most = (samples.size() + block_nodes - 1) / block_nodes;
  for (std::size_t first = 0, end = 0; first < samples.size() && block.rows < block_nodes; first = end) {
    while (end < samples.size() && end - first < most && samples[end].sides == samples[first].sides) ++end;
    const auto count = static_cast<double>(end - first);
    double place = 0.0;
    Vec3 value = Vec3::Zero();
    for (std::size_t i = first; i < end; ++i) place += samples[i].place / count, value += samples[i].value / count;
    sides[static_cast<std::size_t>(block.rows)] = samples[first].sides;
    block.factor.row(block.rows) = (std::sqrt(count) * node_weights(place)).cast<float>();
    block.target.row(block.rows) = (std::sqrt(count) * value).transpose().cast<float>();
    ++block.rows;
    block.samples += static_cast<std::int32_t>(count);
  }
}

}  // namespace

InsClippedBlocks clipped_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                const SplineGrid& grid, double clock_offset) {
  const bool is_gyroscope = instrument == InsInstrument::gyroscope;
  const TriadColumns& triad = is_gyroscope ? sensor.angular_velocity : sensor.acceleration;
  const Fault clipped = is_gyroscope ? angular_velocity_clipped : acceleration_clipped;
  const unsigned unusable =
      is_gyroscope ? angular_velocity_missing | angular_velocity_spike : acceleration_missing | acceleration_spike;
  InsClippedBlocks result;
  const double range = clipping_range(sensor, triad, clipped);
  if (!(range > 0.0)) return result;
  std::vector<std::vector<ClippedSample>> samples(static_cast<std::size_t>(grid.intervals));
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (!(sensor.faults[row] & clipped) || (sensor.faults[row] & unusable)) continue;
    const double where = (time[row] + clock_offset - grid.begin) / grid.period, interval = std::floor(where);
    if (interval < 0.0 || interval >= static_cast<double>(grid.intervals)) continue;
    samples[static_cast<std::size_t>(interval)].push_back(
        {where - interval, triad.at(row), clipped_sides(sensor, triad, clipped, range, row)});
  }
  result.blocks.resize(samples.size());
  result.sides.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) put_rows(samples[k], result.blocks[k], result.sides[k]);
  return result;
}

}  // namespace kinfer
