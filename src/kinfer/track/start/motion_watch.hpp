// SPDX-License-Identifier: Apache-2.0
// Which sensors show that they move: angular velocity beyond bias and noise, or a specific force that changes. Where
// the parent of a joint rests, the noise of both sensors says nothing of the joint, however long it is gathered.
#pragma once

#include "kinfer/track/filter/chain_filter.hpp"
#include "kinfer/track/filter/thresholds.hpp"

namespace kinfer::track {

class MotionWatch {
 public:
  explicit MotionWatch(const FilterModel& model);

  void add(const BlockMeasurement& block, const ChainFilter& filter);
  void reset();

  bool moves(std::size_t sensor) const { return sensors_[sensor].strength > 1.0; }
  /// Where sensors disagree, less motion is needed to put it down to that.
  bool may_move(std::size_t sensor) const { return sensors_[sensor].strength > motion_suspicion; }

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
