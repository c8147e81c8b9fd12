// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/rows/row_feed.hpp"

namespace kinfer::track {
namespace {

std::vector<double> clock_offsets(const TrackingModel& model) {
  std::vector<double> offsets;
  for (const TrackingSensor& sensor : model.sensors) offsets.push_back(sensor.clock_offset);
  return offsets;
}

}  // namespace

RowFeed::RowFeed(const TrackingModel& model, double longest_delay)
    : order_(longest_delay), clocks_(clock_offsets(model)) {}

Result<void> RowFeed::add(const InsRow& row, const InsRowSink& sink) {
  return order_.add(row, [&](const InsRow& next) { return clocks_.add(next, sink); });
}

Result<void> RowFeed::finish(const InsRowSink& sink) {
  if (auto done = order_.finish([&](const InsRow& next) { return clocks_.add(next, sink); }); !done) return done;
  return clocks_.finish(sink);
}

}  // namespace kinfer::track
