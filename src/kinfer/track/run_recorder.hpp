// SPDX-License-Identifier: Apache-2.0
// Keeps a run of any length in bounded memory, for its summary and report: bins that double when there are too many.
#pragma once

#include "kinfer/evidence/tracking/track_run.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer::track {

class RunRecorder {
 public:
  explicit RunRecorder(const TrackingModel& model);

  void add(const TrackState& state);

  /// Without verdict, sentences, remarks and provenance.
  TrackRun run() const;

 private:
  struct Bin {
    double begin = 0.0, end = 0.0;  // [s]
    int rows = 0, tool_rows = 0;
    VectorXd low, high, sd;    // of each position
    VectorXd innovation;       // sum, of each sensor
    Vec3 tool = Vec3::Zero();  // the last
    double tool_sd = 0.0;
  };

  void start_bin(const TrackState& state);
  void merge_pairs();
  void follow_alarms(const TrackState& state);

  const TrackingModel model_;
  std::vector<Bin> bins_;
  int rows_per_bin_ = 1;
  std::int64_t rows_ = 0;
  std::vector<TrackJointShare> shares_;  // rows, not yet shares
  std::vector<TrackEvent> events_;
};

}  // namespace kinfer::track
