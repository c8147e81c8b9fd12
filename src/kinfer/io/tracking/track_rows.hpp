// SPDX-License-Identifier: Apache-2.0
// States of a tracked machine as rows of text: CSV and JSON lines (docs/formats.md).
#pragma once

#include <string>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer {

/// Appends rows to a buffer that the caller empties; knows the names and units of the columns.
class TrackRowWriter {
 public:
  explicit TrackRowWriter(const TrackingModel& model);

  std::string header() const;                                         ///< of the CSV, with its end of line
  void append_csv(const TrackState& state, std::string& out) const;   ///< with its end of line; unknown: an empty cell
  void append_json(const TrackState& state, std::string& out) const;  ///< SI; unknown: null

 private:
  std::string alarm_cell(const TrackState& state) const;

  std::vector<std::string> positions_, sensors_, joints_;
  std::vector<double> unit_;  ///< [rad] or [m] of one unit of the CSV
};

}  // namespace kinfer
