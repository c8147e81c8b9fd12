// SPDX-License-Identifier: Apache-2.0
// What is known of the joint positions of a filter since it began: a position is known, or motion will show it, or it
// counts from the start.
#pragma once

#include <vector>

#include "kinfer/track/start/initial_posture.hpp"

namespace kinfer::track {

/// Of a position that is not known, the standard deviations [rad] hold what its zero may be off beyond the filter's.
struct KnownPosition {
  bool is_known = false;
  bool is_open = false;      ///< motion will show it, and has not yet
  bool is_relative = false;  ///< counts from the start for good: its zero is unknown
  double start_sd = 0.0;     ///< of where it counts from
  double lost_sd = 0.0;      ///< of what it has turned unseen since then: in a gap, or without its sensor

  /// What is missing in the filter's standard deviation. A position that counts from the start has none but for what
  /// was lost; one that is open may be anywhere.
  double missing_sd() const { return is_known ? 0.0 : is_open && !is_relative ? start_sd : lost_sd; }
};

class KnownPositions {
 public:
  explicit KnownPositions(const FilterModel& model);

  /// Of a start in a posture, before or after which the base may move.
  void begin(const FilterModel& model, const InitialPosture& posture, BaseMode base);
  /// What counted from the start will be shown by motion.
  void let_base_move(const FilterModel& model);
  /// Whether the heading of a body's spherical joint counts from the start.
  bool has_open_heading(const FilterModel& model, std::size_t body) const;
  /// Motion has shown where the body's joint stands.
  void decide(const FilterModel& model, std::size_t body);
  /// It has turned unseen, and is not found.
  void lose(Index position, double sd, BaseMode base);

  /// The first body whose joint moves so, is open and told by what moves now; 0: none.
  template <class IsTold>
  std::size_t first_open(const FilterModel& model, JointMotion motion, const IsTold& is_told) const {
    for (std::size_t b = 1; b < model.bodies.size(); ++b) {
      const Index at = model.layout.position[b];
      if (at >= 0 && model.bodies[b].motion == motion && positions_[static_cast<std::size_t>(at)].is_open && is_told(b))
        return b;
    }
    return 0;
  }

  std::size_t size() const { return positions_.size(); }
  const KnownPosition& operator[](std::size_t position) const { return positions_[position]; }
  /// [rad] of where the body's joint counts from; 0 for joints without positions.
  double start_sd(const FilterModel& model, std::size_t body) const;

 private:
  std::vector<KnownPosition> positions_;
};

}  // namespace kinfer::track
