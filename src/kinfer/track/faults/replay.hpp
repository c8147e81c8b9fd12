// SPDX-License-Identifier: Apache-2.0
// The last seconds once more, in the light of what they showed: without a sensor that turned out to be faulty, or with
// a base that turned out to move. Until then the filter has believed otherwise. Two earlier filters and the blocks
// since the older of them are kept.
#pragma once

#include <span>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class Replay {
 public:
  explicit Replay(const ChainFilter& filter);

  /// After each update of `filter` by `block`; nothing is allocated.
  void add(const BlockMeasurement& block, const ChainFilter& filter);

  /// From the older of the two filters kept, after `prepare` has changed it; `visit(filter, block)` after each block.
  template <class Prepare, class Visit>
  void run(ChainFilter& filter, const Prepare& prepare, const Visit& visit) {
    filter = beginning(filter);
    prepare(filter);
    for (std::size_t i = 0; i < count_; ++i) {
      const BlockMeasurement& block = blocks_[i];
      filter.predict(block.time);
      filter.update(block);
      visit(filter, block);
    }
    begin(filter);
  }

  /// The older of the two filters kept, which trusts the sensors as `filter` does, and the blocks since.
  ChainFilter beginning(const ChainFilter& filter) const {
    ChainFilter older = older_;
    older.judge_as(filter);
    return older;
  }
  std::span<const BlockMeasurement> blocks() const { return {blocks_.data(), count_}; }

  /// Forgets what was before.
  void begin(const ChainFilter& filter);

 private:
  ChainFilter older_, newer_;
  std::vector<BlockMeasurement> blocks_;  // since the older one
  std::size_t count_ = 0, newer_at_ = 0;  // blocks in use; of them before the newer filter
};

}  // namespace kinfer::track
