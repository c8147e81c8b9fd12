// SPDX-License-Identifier: Apache-2.0
// Several starts at once, where gravity does not tell a joint position but the base's motion will: a filter from each
// place on a grid, until their likelihoods tell. One filter that begins with a large standard deviation ends confident
// and wrong, because its linearisation holds for small angles only.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class StartGrid {
 public:
  /// From `filter`, with the angle `position` all around the circle.
  StartGrid(const ChainFilter& filter, Index position);

  void update(const BlockMeasurement& block);

  /// Only one place is left, or all that are left agree.
  bool is_decided() const { return candidates_.size() == 1; }
  const ChainFilter& best() const;
  Index position() const { return position_; }

 private:
  void drop_unlikely();
  void merge();

  struct Candidate {
    ChainFilter filter;
    double log_weight = 0.0;
  };
  Index position_;
  std::vector<Candidate> candidates_;
};

}  // namespace kinfer::track
