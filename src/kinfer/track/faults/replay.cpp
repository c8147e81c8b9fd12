// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/replay.hpp"

#include <algorithm>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {

Replay::Replay(const ChainFilter& filter) : older_(filter), newer_(filter) {
  BlockMeasurement empty;
  empty.sensors.resize(filter.model().sensors.size());
  blocks_.assign(2 * replay_blocks, empty);
}

void Replay::begin(const ChainFilter& filter) {
  older_ = newer_ = filter;
  count_ = newer_at_ = 0;
}

void Replay::add(const BlockMeasurement& block, const ChainFilter& filter) {
  blocks_[count_++] = block;
  if (count_ - newer_at_ < replay_blocks) return;
  // The older filter and the blocks up to the newer one are no longer needed.
  std::rotate(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(newer_at_), blocks_.end());
  count_ -= newer_at_;
  std::swap(older_, newer_);
  newer_ = filter;
  newer_at_ = count_;
}

}  // namespace kinfer::track
