// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/base_watch.hpp"

#include <cmath>

#include "kinfer/track/filter/thresholds.hpp"

namespace kinfer::track {
BaseWatch::BaseWatch(const TrackingModel& model, const FilterModel& filter, std::optional<BaseMode> given)
    : is_given_(given.has_value()),
      mode_(given.value_or(model.base.moved ? BaseMode::moving : BaseMode::still)), sensor_(model.bodies.front().sensor) {
  if (sensor_ < 0) {
    mode_ = given.value_or(BaseMode::moving);
    return;
  }
  const SensorSettings& s = filter.sensors[static_cast<std::size_t>(sensor_)];
  const Index own = sensor_states * sensor_;
  const double bias = std::sqrt(filter.parameters.diagonal().segment<3>(own + SensorIndex::gyroscope_bias).maxCoeff());
  const double noise = std::hypot(s.white.rate, s.persistent.rate) * std::sqrt(s.sample_period / base_mean);
  rate_limit_ = base_rate + base_significance * std::hypot(noise, bias);
}

void BaseWatch::add(const BlockMeasurement& block, const ChainState& state) {
  if (is_given_ || mode_ == BaseMode::moving || sensor_ < 0) return;
  const BlockSample& sample = block.sensors[static_cast<std::size_t>(sensor_)];
  if (sample.rate_count == 0) return;
  const Vec3 rate = sample.rate - state.sensors[static_cast<std::size_t>(sensor_)].gyroscope_bias;
  rate_ += (rate - rate_) * (1.0 - std::exp(-block.length / base_mean));
  seen_ += block.length;
  if (rate_.norm() > rate_limit_ && seen_ > base_mean) mode_ = BaseMode::moving;
}

}  // namespace kinfer::track
