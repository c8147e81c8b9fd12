// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_orientations.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/inertial/clipped_peaks.hpp"
#include "kinfer/inertial/gap_bridging.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

Result<void> expect_specific_force(const InsRecording& recording, const InsSensor& sensor) {
  const bool has_any =
      std::ranges::any_of(sensor.faults, [](std::uint8_t bits) { return !(bits & acceleration_missing); });
  if (has_any) return {};
  return error(
      "{}: sensor {}: no row has a specific force, so its orientation is unknown; select another one with --sensor",
      recording.loggers[sensor.logger].name, sensor.name);
}

SensorOrientations orientations_of(const InsRecording& recording, std::size_t index, const FilterOptions& options) {
  const InsSensor& sensor = recording.sensors[index];
  const std::span<const double> time = recording.time(sensor);
  const OrientationFilter& filter = filter_of(options);
  const bool uses_field = magnetometer_use(options) == MagnetometerUse::automatic;
  return {
      .sensor = index,
      .world_q_sensor = estimate_orientations(
          filter.is_causal ? sensor : bridge_gaps(restore_clipped_peaks(sensor, time), time, inertial::max_filter_gap),
          time, options),
      .heading_is_north = sensor.has_magnetometer() && uses_field,
      .rest_seconds = bias_at_rest(rest_periods(sensor, time)).seconds};
}

}  // namespace

Result<std::vector<SensorOrientations>> estimate_orientations(const InsRecording& recording,
                                                              std::span<const std::size_t> sensors,
                                                              const FilterOptions& options) {
  for (const std::size_t i : sensors) {
    KINFER_EXPECT(i < recording.sensors.size(), "sensor {} of {}", i, recording.sensors.size());
    if (auto usable = expect_specific_force(recording, recording.sensors[i]); !usable)
      return forward_error(usable.error());
  }
  std::vector<SensorOrientations> orientations;
  for (const std::size_t i : sensors)  // sequentially: the smoother needs memory for one sensor only
    orientations.push_back(orientations_of(recording, i, options));
  return orientations;
}

}  // namespace kinfer
