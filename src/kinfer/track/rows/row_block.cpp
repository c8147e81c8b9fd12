// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rows/row_block.hpp"

#include <algorithm>

namespace kinfer::track {

RowBlock::RowBlock(std::size_t sensors) {
  sum_.sensors.resize(sensors);
  mean_.sensors.resize(sensors);
}

void RowBlock::clear() {
  std::ranges::fill(sum_.sensors, BlockSample{});
  sum_.time = 0.0;
  rows_ = 0;
}

/// The median of the last steps, of two the shorter one: neither rows that are lost nor a pause make it longer.
void RowBlock::follow_period(double step) {
  steps_[step_count_++ % steps_.size()] = step;
  std::array<double, period_steps> ordered = steps_;
  const std::size_t count = std::min(step_count_, ordered.size());
  const auto begin = ordered.begin(), end = begin + static_cast<std::ptrdiff_t>(count),
             middle = begin + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(begin, middle, end);
  period_ = *middle;
}

void RowBlock::add(const InsRow& row) {
  if (rows_ == 0) {
    stands_alone_ = is_beyond_gap(row.time);
    begin_ = row.time;
  }
  if (has_rows_ && row.time > end_) follow_period(row.time - end_);
  has_rows_ = true;
  end_ = row.time;
  sum_.time += row.time - begin_;
  ++rows_;
  for (std::size_t s = 0; s < sum_.sensors.size(); ++s) {
    const InsSample& sample = row.sensors[s];
    BlockSample& to = sum_.sensors[s];
    if (sample.has_angular_velocity && !sample.angular_velocity_clipped)
      to.rate += sample.angular_velocity, to.rate_time += row.time - begin_, ++to.rate_count;
    if (sample.has_acceleration) to.force += sample.acceleration, to.force_time += row.time - begin_, ++to.force_count;
  }
}

bool RowBlock::is_complete(double length) const {
  // A margin of half a period, since times are rounded.
  return rows_ > 0 && (stands_alone_ || end_ - begin_ + 1.5 * period_ > length);
}

bool RowBlock::is_beyond_gap(double time) const {
  return period_ > 0.0 && time - end_ > longest_bridge + period_;
}

bool RowBlock::ends_before(double time) const {
  return rows_ > 0 && is_beyond_gap(time);
}

const BlockMeasurement& RowBlock::mean() {
  mean_ = sum_;
  const double middle = sum_.time / std::max(1, rows_);
  mean_.time = begin_ + middle;
  mean_.length = length();
  for (BlockSample& sample : mean_.sensors) {
    if (sample.rate_count > 0)
      sample.rate /= sample.rate_count, sample.rate_time = sample.rate_time / sample.rate_count - middle;
    if (sample.force_count > 0)
      sample.force /= sample.force_count, sample.force_time = sample.force_time / sample.force_count - middle;
  }
  return mean_;
}

BlockMeasurement mean_of(std::span<const BlockMeasurement> blocks) {
  BlockMeasurement mean;
  if (blocks.empty()) return mean;
  mean.sensors.resize(blocks.front().sensors.size());
  for (const BlockMeasurement& block : blocks) {
    mean.time += block.time / static_cast<double>(blocks.size());
    for (std::size_t s = 0; s < mean.sensors.size(); ++s) {
      const BlockSample& from = block.sensors[s];
      BlockSample& to = mean.sensors[s];
      to.rate += from.rate_count * from.rate;
      to.force += from.force_count * from.force;
      to.rate_count += from.rate_count;
      to.force_count += from.force_count;
    }
  }
  mean.length = blocks.back().time - blocks.front().time + blocks.back().length;
  const BlockMeasurement &first = blocks.front(), &last = blocks.back();
  for (std::size_t s = 0; s < mean.sensors.size(); ++s) {
    BlockSample& sample = mean.sensors[s];
    if (sample.rate_count > 0) sample.rate /= sample.rate_count;
    if (sample.force_count > 0) sample.force /= sample.force_count;
    if (last.time > first.time && first.sensors[s].rate_count > 0 && last.sensors[s].rate_count > 0)
      sample.angular_acceleration = (last.sensors[s].rate - first.sensors[s].rate).norm() / (last.time - first.time);
  }
  return mean;
}

}  // namespace kinfer::track
