// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rest/base_watch.hpp"

#include <cmath>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
BaseWatch::BaseWatch(const TrackingModel& model, const FilterModel& filter, std::optional<BaseMode> given)
    : is_given_(given.has_value()),
      mode_(given.value_or(model.base.moved ? BaseMode::moving : BaseMode::still)),
      sensor_(model.bodies.front().sensor) {
  if (sensor_ < 0) {
    mode_ = given.value_or(BaseMode::moving);
    return;
  }
  const SensorSettings& s = filter.sensors[static_cast<std::size_t>(sensor_)];
  noise_ = std::hypot(s.white.rate, s.persistent.rate) * std::sqrt(s.sample_period / base_mean);
}

void BaseWatch::add(const BlockMeasurement& block, const ChainFilter& filter) {
  if (is_given_ || mode_ == BaseMode::moving || sensor_ < 0) return;
  const BlockSample& sample = block.sensors[static_cast<std::size_t>(sensor_)];
  if (sample.rate_count == 0) return;
  rate_ += (sample.rate - rate_) * (1.0 - std::exp(-block.length / base_mean));
  seen_ += block.length;
  judge(filter, 1.0);
}

void BaseWatch::suspect(const ChainFilter& filter) {
  judge(filter, motion_suspicion);
}

void BaseWatch::judge(const ChainFilter& filter, double share) {
  if (is_given_ || sensor_ < 0 || seen_ <= base_mean) return;
  const Index own = filter.model().layout.sensor_state(sensor_) + SensorIndex::gyroscope_bias;
  const double bias_variance = filter.covariance().diagonal().segment<3>(own).maxCoeff();
  const double limit = base_rate + base_significance * std::sqrt(noise_ * noise_ + bias_variance);
  // The bias as it is known now: that of the first rows was a guess.
  const Vec3 rate = rate_ - filter.state().sensors[static_cast<std::size_t>(sensor_)].gyroscope_bias;
  if (rate.norm() > share * limit) mode_ = BaseMode::moving;
}

}  // namespace kinfer::track
