// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/foreign/ins_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/ins/unit_check.hpp"

namespace kinfer {
namespace {

void add_remark(InsRecording& recording, std::string sentence) {
  recording.remarks.push_back(std::move(sentence));
}

void add_fault_remarks(InsRecording& out, const InsSensor& sensor) {
  const auto add_count_remark = [&](Fault fault, const char* what) {
    if (const std::size_t n = count(sensor, fault); n > 0)
      add_remark(out, fmt::format("{}: {} of {} rows {}", sensor.name, n, sensor.rows(), what));
  };
  add_count_remark(acceleration_clipped, "clip the accelerometer's range and are not used");
  add_count_remark(angular_velocity_clipped, "clip the gyroscope's range: the turn is larger than they say");
  add_count_remark(acceleration_spike, "are single spikes of the accelerometer and are not used");
  add_count_remark(angular_velocity_spike, "are single spikes of the gyroscope and are not used");
  const std::size_t death = find_usable_end(sensor);
  if (death == sensor.rows()) return;
  if (death == 0)
    return add_remark(out, fmt::format("{}: no row has both specific force and angular rate", sensor.name));
  const auto time = out.time(sensor);
  if (time.back() - time[death - 1] > 1.0)
    add_remark(out, fmt::format("{}: says nothing after {:.3f} s ({} rows): its orientation is held there", sensor.name,
                                time[death - 1], sensor.rows() - death));
}

bool is_gauss(const InsSensor& sensor) {
  return std::abs(field_unit(sensor).value_or(1.0) - 100.0) < 1e-9;
}

void convert_gauss(InsRecording& out, InsSensor& sensor) {
  for (auto& axis : sensor.field.axis)
    for (float& value : axis) value *= 100.0F;
  flag_faults(sensor);
  add_remark(out,
             fmt::format("{0}: the magnetic field is taken to be in gauss; state its unit in brackets, {0}_mx[G], or "
                         "{0}_mx[1] where it is arbitrary",
                         sensor.name));
}

}  // namespace

Result<void> screen_sensors(InsRecording& out, std::size_t first, const std::string& name,
                            std::span<const std::array<bool, 3>> stated) {
  for (std::size_t i = first; i < out.sensors.size(); ++i) {
    InsSensor& sensor = out.sensors[i];
    flag_faults(sensor);
    const std::array<bool, 3>& has_unit = stated[i - first];
    for (const UnitWarning& doubt : check_units(sensor, has_unit[2])) {
      const bool is_unstated = doubt.is_other_unit && !has_unit[doubt.instrument];
      if (is_unstated && doubt.instrument == 2 && is_gauss(sensor)) {
        convert_gauss(out, sensor);
        continue;
      }
      if (is_unstated) continue;  // a diagnosis of the log converts it, and says so
      if (doubt.fatal) return error("{}: {}", name, doubt.sentence);
      add_remark(out, doubt.sentence);
      sensor.field = {};
    }
    add_fault_remarks(out, sensor);
  }
  return {};
}

void add_time_remarks(InsRecording& out, std::size_t logger, const std::string& name) {
  const auto& time = out.loggers[logger].time;
  if (time.size() == 1) add_remark(out, fmt::format("{}: one single row: no motion can be told from it", name));
  constexpr double shortest_reported_gap = 0.1;  // [s]
  std::size_t n = 0;
  double longest = 0.0;
  for (const TimeGap& gap : gaps(time))
    if (gap.end - gap.begin > shortest_reported_gap) ++n, longest = std::max(longest, gap.end - gap.begin);
  if (n > 0)
    add_remark(out,
               fmt::format("{}: {} gaps in time, the longest {:.3g} s: nothing is known in between", name, n, longest));
}

}  // namespace kinfer
