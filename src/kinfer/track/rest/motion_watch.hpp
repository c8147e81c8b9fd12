// SPDX-License-Identifier: Apache-2.0
// Which sensors show that they move: angular velocity beyond bias and noise, or a specific force that changes. Where
// the parent of a joint rests, the noise of both sensors says nothing of the joint, however long it is gathered.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class MotionWatch {
 public:
  explicit MotionWatch(const FilterModel& model);

  void add(const BlockMeasurement& block, const ChainFilter& filter);
  void reset();

  /// Whether the parent of the body's joint moves, so that it tells where the joint stands; by `share` of the motion
  /// that is certain. A prismatic joint is told by the rates that its own axes have.
  bool tells_of(const FilterModel& model, std::size_t body, double share = 1.0) const;
  /// What a displacement is told by, too: its joint begins anywhere, but at rest rows say nothing of where.
  bool moves_parent(const FilterModel& model, std::size_t body, double share = 1.0) const;

 private:
  struct Sensor {
    Vec3 rate = Vec3::Zero(), force = Vec3::Zero(), usual_force = Vec3::Zero();  // means over short and long times
    double seen = 0.0;                                                           // [s]
    double strength = 0.0;  // of its motion, over what noise and bias may be
  };
  std::vector<InsLevel> noise_;  // of the short means
  std::vector<Sensor> sensors_;
};

}  // namespace kinfer::track
