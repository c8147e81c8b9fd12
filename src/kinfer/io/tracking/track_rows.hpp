// SPDX-License-Identifier: Apache-2.0
// States of a tracked machine as rows of text: CSV and JSON lines (docs/formats.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer {

/// Where the base's sensor is in the world, and the heading of its x axis there, when tracking begins.
struct BasePlace {
  Vec3 position = Vec3::Zero();  ///< [m]
  double heading = 0.0;          ///< [rad] from the world's x axis
};

/// Appends rows to a buffer that the caller empties; knows the names and units of the columns.
class TrackRowWriter {
 public:
  /// `place`: adds the tool's pose in the world, for a base that keeps its place.
  explicit TrackRowWriter(const TrackingModel& model, std::optional<BasePlace> place = {});

  std::string header() const;                                   ///< of the CSV, with its end of line
  void append_csv(const TrackState& state, std::string& out);   ///< with its end of line; unknown: an empty cell
  void append_json(const TrackState& state, std::string& out);  ///< SI; unknown: null

 private:
  std::string alarm_cell(const TrackState& state) const;
  Pose tool_in_world(const TrackState& state);

  std::vector<std::string> positions_, sensors_, joints_;
  std::optional<BasePlace> place_;
  std::optional<double> first_heading_{};  ///< [rad] of the base's x axis in the state's world
  std::vector<double> unit_;               ///< [rad] or [m] of one unit of the CSV
};

}  // namespace kinfer
