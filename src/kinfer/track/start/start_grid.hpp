// SPDX-License-Identifier: Apache-2.0
// Several starts at once, where gravity does not determine a joint position but motion will: a filter from each place
// on a grid, until their likelihoods decide. One filter that begins with a large standard deviation ends confident and
// wrong, because its linearisation holds for small angles only.
#pragma once

#include "kinfer/track/start/known_positions.hpp"

namespace kinfer::track {

class StartGrid {
 public:
  /// A start that is still possible.
  struct Candidate {
    ChainFilter filter;
    double log_weight = 0.0;
    double probability = 0.0;  ///< among all
    bool is_stated = false;
    std::size_t place = 0;  ///< on the grid as it began
  };

  /// From `filter`, with the angle of the body's joint all around the circle. Of what is known of it: standard
  /// deviation of where it is in `filter`, and of that what it has turned unseen since the start.
  static StartGrid around(const ChainFilter& filter, std::size_t body, const KnownPosition& known);
  /// From `filter`, with the limb that begins with the body anywhere around the axis of its segment.
  static StartGrid of_limb(const ChainFilter& filter, std::size_t body);
  /// From `filter`, with the displacement of the body's joint within `guess` and its standard deviation on both sides.
  static StartGrid along(const ChainFilter& filter, std::size_t body, const PositionGuess& guess);

  /// `tells`: what the sensors show depends on the position.
  void update(const BlockMeasurement& block, bool tells);

  /// Of what is sought about where the stated filter has it [rad²] or [m²].
  double variance() const;
  /// Of the places by their probabilities [nat]: its exponential is how many are left.
  double entropy() const;
  /// [s] since when nothing has.
  double untold_since() const { return untold_since_; }

  /// Only one place is left, or all that are left agree.
  bool is_decided() const { return candidates_.size() == 1; }
  /// The one that stands for all: first that where the filter was, and another where the mean squared distance of all
  /// from it is less than half.
  const ChainFilter& stated() const;
  std::span<const Candidate> candidates() const { return candidates_; }
  /// To correct each filter by what does not tell them apart.
  std::span<Candidate> candidates() { return candidates_; }
  std::size_t body() const { return body_; }
  JointMotion motion() const { return motion_; }
  /// What is sought is how a limb is turned on its segment.
  bool is_of_limb() const { return is_of_limb_; }
  /// Of the joint that is sought; −1: a limb's turn is.
  Index position() const { return is_of_limb_ ? -1 : position_; }

 private:
  StartGrid(const ChainFilter& filter, std::size_t body, bool is_of_limb = false);
  double value(const ChainFilter& filter) const;
  double distance(const ChainFilter& a, const ChainFilter& b) const;
  double variance_about(const Candidate& candidate) const;
  void number();
  void drop_unlikely();
  void merge();
  void weigh();
  void choose();

  std::size_t body_;
  bool is_of_limb_;
  JointMotion motion_;
  Index position_;  // of the filter, the joint's first
  Index state_;     // of what is sought
  int updates_ = 0;
  double untold_since_ = 0.0;  // [s]
  std::vector<Candidate> candidates_;
};

}  // namespace kinfer::track
