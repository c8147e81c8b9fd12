// SPDX-License-Identifier: Apache-2.0
// A run of a tracker in bounded size: long signals in bins, alarms as events.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinfer/evidence/facts/records.hpp"
#include "kinfer/evidence/tracking/track_state.hpp"

namespace kinfer {

/// One joint position over time, a value for each bin; NaN where it is unknown.
struct TrackCurve {
  std::string name{};
  bool rotates = true;                      ///< [rad], else [m]
  std::vector<double> low{}, high{}, sd{};  ///< smallest and largest value, largest standard deviation
};

/// A sensor's innovation against all others, over what is expected; the mean of each bin.
struct TrackSensorCurve {
  std::string name{};
  std::vector<double> innovation{};
};

struct TrackEvent {
  TrackAlarm alarm{};
  double until = 0.0;  ///< [s] NaN: active to the end
  std::string sentence{};
};

/// Where the positions of a joint came from.
struct TrackJointShare {
  std::string name{};
  double composed = 0.0;           ///< share of the rows in which they came from composed orientations
  double relative_to_start = 0.0;  ///< share in which they counted from the start, not from the chain's zero
  double unknown = 0.0;            ///< share in which they were unknown
};

struct TrackRun {
  VerdictRecord verdict{};
  double begin = 0.0, end = 0.0;  ///< [s]
  std::int64_t rows = 0;
  std::vector<double> time{};  ///< [s] middle of each bin
  std::vector<TrackCurve> positions{};
  std::vector<TrackSensorCurve> sensors{};
  std::vector<Vec3> tool{};       ///< [m] in the base sensor's frame, one for each bin
  std::vector<double> tool_sd{};  ///< [m] largest of the three axes and of the bin
  std::vector<TrackJointShare> joints{};
  std::vector<TrackEvent> events{};
  std::vector<std::string> remarks{};  ///< on the log, one sentence each
  ProvenanceRecord provenance{};
};

}  // namespace kinfer
