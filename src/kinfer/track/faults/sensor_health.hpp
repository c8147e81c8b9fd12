// SPDX-License-Identifier: Apache-2.0
// Faults that a sensor's own samples show: none come, or none of one instrument, the same come again and again, they
// are at the range.
#pragma once

#include <array>
#include <vector>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer::track {

struct SensorHealth {
  double last_sample = 0.0;                  ///< [s]
  double last_rate = 0.0, last_force = 0.0;  ///< [s] of either instrument
  double last_change = 0.0;                  ///< [s] when a value changed
  double last_clipped = -1e9;                ///< [s]
  bool lost = false, stuck = false, clipped = false;
  bool instrument_lost = false;     ///< one instrument measures without the other
  bool instrument_missing = false;  ///< likewise, for a short time
  bool measures() const { return !lost && !stuck; }
  double lost_since = 0.0, stuck_since = 0.0, instrument_lost_since = 0.0;  ///< [s]
};

/// What of it is an alarm of the sensor.
void add_alarms(const SensorHealth& health, int sensor, std::vector<TrackAlarm>& alarms);

class HealthWatch {
 public:
  explicit HealthWatch(std::size_t sensors) : health_(sensors), before_(sensors), repeats_(sensors, 0) {}

  void add(const InsRow& row);
  const SensorHealth& operator[](std::size_t sensor) const { return health_[sensor]; }

 private:
  std::vector<SensorHealth> health_;
  std::vector<InsSample> before_;
  std::vector<int> repeats_;
  bool has_begun_ = false;
};

}  // namespace kinfer::track
