// SPDX-License-Identifier: Apache-2.0
// Do no harm: where the innovations of a joint's two sensors say that the chain does not fit there, its positions come
// from the orientations of these two sensors alone.
#pragma once

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class JointChoice {
 public:
  explicit JointChoice(const TrackingModel& model);

  /// Compares the instruments' residuals with those of the identification.
  void update(const ChainFilter& filter);

  /// Replaces joints of `chain` by those of `composed` where they are better; positions that count from the start go
  /// on from where they are.
  void apply(const TrackingModel& model, const TrackState& composed, TrackState& chain);

 private:
  struct Joint {
    int parent_sensor = -1, child_sensor = -1;  ///< −1: a body without a sensor
    bool misfits = false, is_composed = false;
    Vec3 offset = Vec3::Zero();
  };
  std::vector<Joint> joints_;
};

}  // namespace kinfer::track
