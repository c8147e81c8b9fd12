// SPDX-License-Identifier: Apache-2.0
// Several starts at once, where gravity does not determine a joint position but motion will: a filter from each place
// on a grid, until their likelihoods decide. One filter that begins with a large standard deviation ends confident and
// wrong, because its linearisation holds for small angles only.
#pragma once

#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

class StartGrid {
 public:
  /// From `filter`, with the angle `position` all around the circle.
  static StartGrid around(const ChainFilter& filter, Index position);
  /// From `filter`, with the displacement `position` within `guess` and its standard deviation on both sides.
  static StartGrid along(const ChainFilter& filter, Index position, const PositionGuess& guess);

  void update(const BlockMeasurement& block);

  /// Only one place is left, or all that are left agree.
  bool is_decided() const { return candidates_.size() == 1; }
  /// Of those that are left the one nearest to where the filter was: until one is chosen, the position counts from
  /// there.
  const ChainFilter& best() const;
  Index position() const { return position_; }

 private:
  StartGrid(Index position, bool is_angle) : position_(position), is_angle_(is_angle) {}
  void add_place(const ChainFilter& filter, double value, double sd, int steps_away);
  void drop_unlikely();
  void merge();

  struct Candidate {
    ChainFilter filter;
    double log_weight = 0.0;
    int steps_away = 0;
  };
  Index position_;
  bool is_angle_;
  int updates_ = 0;
  std::vector<Candidate> candidates_;
};

}  // namespace kinfer::track
