// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/sensor_health.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

bool is_same(const InsSample& a, const InsSample& b) {
  return (a.acceleration - b.acceleration).cwiseAbs().maxCoeff() <= 0.0 &&
         (a.angular_velocity - b.angular_velocity).cwiseAbs().maxCoeff() <= 0.0;
}

}  // namespace

void add_alarms(const SensorHealth& health, int sensor, std::vector<TrackAlarm>& alarms) {
  const auto add = [&](TrackAlarmKind kind, double since) {
    alarms.push_back({.kind = kind, .sensor = sensor, .since = since});
  };
  if (health.lost)
    add(TrackAlarmKind::sensor_lost, health.lost_since);
  else if (health.instrument_lost)
    add(TrackAlarmKind::sensor_lost, health.instrument_lost_since);
  if (health.stuck) add(TrackAlarmKind::sensor_stuck, health.stuck_since);
  if (health.clipped) add(TrackAlarmKind::sensor_clipped, health.last_clipped);
}

void HealthWatch::add(const InsRow& row) {
  for (std::size_t s = 0; s < health_.size(); ++s) {
    SensorHealth& health = health_[s];
    const InsSample& sample = row.sensors[s];
    if (!has_begun_) health.last_sample = health.last_change = health.last_rate = health.last_force = row.time;
    if (sample.has_angular_velocity) health.last_rate = row.time;
    if (sample.has_acceleration) health.last_force = row.time;
    if (sample.has_acceleration || sample.has_angular_velocity) {
      health.last_sample = row.time;
      const bool repeats = sample.has_acceleration && sample.has_angular_velocity && is_same(sample, before_[s]);
      repeats_[s] = repeats ? repeats_[s] + 1 : 0;
      if (!repeats) health.last_change = row.time;
      before_[s] = sample;
    }
    if (sample.angular_velocity_clipped) health.last_clipped = row.time;
    const bool was_lost = health.lost, was_stuck = health.stuck;
    health.lost = row.time - health.last_sample > lost_after;
    health.stuck = repeats_[s] >= stuck_rows && row.time - health.last_change > stuck_after;
    health.clipped = row.time - health.last_clipped < clipped_memory;
    const double alone = std::abs(health.last_rate - health.last_force);
    health.instrument_missing = alone > instrument_missing_after;
    health.instrument_lost = alone > instrument_lost_after;
    health.instrument_lost_since = std::min(health.last_rate, health.last_force);
    if (health.lost && !was_lost) health.lost_since = health.last_sample;
    if (health.stuck && !was_stuck) health.stuck_since = health.last_change;
  }
  has_begun_ = true;
}

}  // namespace kinfer::track
