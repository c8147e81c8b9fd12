// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/rows/clock_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double longest_wait = 0.1;  // [s] for a sensor that is lost, beyond its offset
constexpr double widest_gap =
    0.05;  // [s] over which samples are interpolated: as long as one update of a tracker and more

Vec3 between(const Vec3& a, const Vec3& b, double share) {
  return (1.0 - share) * a + share * b;
}

/// Unknown where either is.
InsSample interpolate(const InsSample& a, const InsSample& b, double time) {
  const double share = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0.0;
  InsSample sample{.time = time};
  if (b.time - a.time > widest_gap) return sample;
  sample.acceleration = between(a.acceleration, b.acceleration, share);
  sample.angular_velocity = between(a.angular_velocity, b.angular_velocity, share);
  sample.field = between(a.field, b.field, share);
  sample.has_acceleration = a.has_acceleration && b.has_acceleration;
  sample.has_angular_velocity = a.has_angular_velocity && b.has_angular_velocity;
  sample.has_field = a.has_field && b.has_field;
  sample.angular_velocity_clipped = a.angular_velocity_clipped || b.angular_velocity_clipped;
  return sample;
}

bool holds_anything(const InsSample& sample) {
  return sample.has_acceleration || sample.has_angular_velocity || sample.has_field;
}

}  // namespace

ClockAlignment::ClockAlignment(const std::vector<double>& offsets) {
  for (const double offset : offsets) {
    tracks_.push_back({.offset = std::abs(offset) < least_clock_offset ? 0.0 : offset});
    has_effect_ |= std::abs(offset) >= least_clock_offset;
  }
}

Result<void> ClockAlignment::add(const InsRow& row, const InsRowSink& sink) {
  KINFER_EXPECT(row.sensors.size() == tracks_.size());
  if (!has_effect_) return sink(row);
  for (std::size_t s = 0; s < tracks_.size(); ++s) {
    Track& track = tracks_[s];
    if (track.offset == 0.0 || !holds_anything(row.sensors[s])) continue;
    track.samples.push_back(row.sensors[s]);
    track.samples.back().time = row.time + track.offset;
  }
  waiting_.push_back(row);
  return pass_ready(false, sink);
}

/// All sensors that are off have caught up with this time, or are given up.
bool ClockAlignment::is_ready(double time) const {
  const double newest = waiting_.back().time;
  return std::ranges::all_of(tracks_, [&](const Track& track) {
    if (track.offset == 0.0 || newest > time - track.offset + longest_wait) return true;
    return !track.samples.empty() && track.samples.back().time >= time;
  });
}

void ClockAlignment::fill(InsRow& row) {
  for (std::size_t s = 0; s < tracks_.size(); ++s) {
    std::deque<InsSample>& samples = tracks_[s].samples;
    if (tracks_[s].offset == 0.0) continue;
    while (samples.size() > 1 && samples[1].time < row.time) samples.pop_front();
    const bool is_between = samples.size() > 1 && samples[0].time <= row.time && samples[1].time >= row.time;
    row.sensors[s] = is_between ? interpolate(samples[0], samples[1], row.time) : InsSample{.time = row.time};
  }
}

Result<void> ClockAlignment::pass_ready(bool is_last, const InsRowSink& sink) {
  while (!waiting_.empty() && (is_last || is_ready(waiting_.front().time))) {
    fill(waiting_.front());
    if (auto done = sink(waiting_.front()); !done) return done;
    waiting_.pop_front();
  }
  return {};
}

Result<void> ClockAlignment::finish(const InsRowSink& sink) {
  return pass_ready(true, sink);
}

}  // namespace kinfer
