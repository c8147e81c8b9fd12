// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/ins_recording.hpp"

#include <algorithm>
#include <numeric>

#include "kinfer/base/expect.hpp"

namespace kinfer {

bool share_clock(const InsRecording& recording, std::size_t one, std::size_t other) {
  const int clock = recording.loggers[one].shared_clock;
  return one == other || (clock >= 0 && clock == recording.loggers[other].shared_clock);
}

std::size_t count(const InsSensor& sensor, Fault fault) {
  return static_cast<std::size_t>(
      std::ranges::count_if(sensor.faults, [fault](std::uint8_t bits) { return (bits & fault) != 0; }));
}

InsSample sample(const InsSensor& sensor, std::span<const double> time, std::size_t row) {
  const unsigned bits = sensor.faults[row];
  InsSample sample{.time = time[row]};
  sample.has_acceleration = !(bits & (acceleration_missing | acceleration_clipped | acceleration_spike));
  sample.has_angular_velocity = !(bits & (angular_velocity_missing | angular_velocity_spike));
  sample.angular_velocity_clipped = sample.has_angular_velocity && (bits & angular_velocity_clipped);
  sample.has_field = sensor.has_magnetometer() && !(bits & field_missing);
  if (sample.has_acceleration) sample.acceleration = sensor.acceleration.at(row);
  if (sample.has_angular_velocity) sample.angular_velocity = sensor.angular_velocity.at(row);
  if (sample.has_field) sample.field = sensor.field.at(row);
  return sample;
}

namespace {

std::vector<double> steps_of(std::span<const double> time) {
  std::vector<double> steps(time.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = time[i + 1] - time[i];
  return steps;
}

}  // namespace

double median_period(std::span<const double> time) {
  if (time.size() < 2) return 0.0;
  std::vector<double> steps = steps_of(time);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

double sample_period(std::span<const double> time) {
  const double period = median_period(time);
  if (time.size() < 2 || period >= shortest_sample_period) return period;
  std::vector<double> steps = steps_of(time);
  const auto longest_usual = steps.end() - static_cast<std::ptrdiff_t>(steps.size() / 100 + 1);
  std::ranges::nth_element(steps, longest_usual);
  const double limit = gap_factor * *longest_usual;
  const auto end = std::partition(steps.begin(), steps.end(), [limit](double step) { return step <= limit; });
  return std::accumulate(steps.begin(), end, 0.0) / static_cast<double>(end - steps.begin());
}

std::vector<TimeGap> gaps(std::span<const double> time) {
  const double limit = gap_factor * sample_period(time);
  std::vector<TimeGap> found;
  for (std::size_t row = 1; row < time.size(); ++row)
    if (time[row] - time[row - 1] > limit) found.push_back({row, time[row - 1], time[row]});
  return found;
}

}  // namespace kinfer
