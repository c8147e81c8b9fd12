// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rest/motion_watch.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {

MotionWatch::MotionWatch(const FilterModel& model) : sensors_(model.sensors.size()) {
  for (const SensorSettings& s : model.sensors) {
    const double averaged = std::sqrt(s.sample_period / base_mean);
    noise_.push_back({averaged * std::hypot(s.white.rate, s.persistent.rate),
                      averaged * std::hypot(s.white.force, s.persistent.force)});
  }
}

void MotionWatch::reset() {
  std::ranges::fill(sensors_, Sensor{});
}

void MotionWatch::add(const BlockMeasurement& block, const ChainFilter& filter) {
  for (std::size_t s = 0; s < sensors_.size(); ++s) {
    const BlockSample& sample = block.sensors[s];
    Sensor& of = sensors_[s];
    if (sample.rate_count == 0 || sample.force_count == 0) continue;
    of.seen += block.length;
    const auto follow = [&](Vec3& mean, const Vec3& value, double time) {
      mean += (value - mean) * std::max(block.length / of.seen, 1.0 - std::exp(-block.length / time));
    };
    follow(of.rate, sample.rate, base_mean);
    follow(of.force, sample.force, base_mean);
    follow(of.usual_force, sample.force, usual_force_time);
    if (of.seen <= base_mean) continue;
    const Index own = filter.model().layout.sensor_state(static_cast<Index>(s)) + SensorIndex::gyroscope_bias;
    const double bias_variance = filter.covariance().diagonal().segment<3>(own).maxCoeff(),
                 most_rate = base_rate + base_significance * std::sqrt(noise_[s].rate * noise_[s].rate + bias_variance);
    of.strength = std::max((of.rate - filter.state().sensors[s].gyroscope_bias).norm() / most_rate,
                           (of.force - of.usual_force).norm() / (base_significance * noise_[s].force));
  }
}

bool MotionWatch::tells_of(const FilterModel& model, std::size_t body, double share) const {
  return model.bodies[body].motion == JointMotion::prismatic || moves_parent(model, body, share);
}

bool MotionWatch::moves_parent(const FilterModel& model, std::size_t body, double share) const {
  auto parent = static_cast<std::size_t>(model.bodies[body].parent);
  while (parent > 0 && model.bodies[parent].sensor < 0) parent = static_cast<std::size_t>(model.bodies[parent].parent);
  const int sensor = model.bodies[parent].sensor;
  return sensor < 0 || sensors_[static_cast<std::size_t>(sensor)].strength > share;
}

}  // namespace kinfer::track
