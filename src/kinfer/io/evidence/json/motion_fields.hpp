// SPDX-License-Identifier: Apache-2.0
// Members of the motion of an identification, in the order of the file.
#pragma once

#include "kinfer/evidence/identification/traces.hpp"
#include "kinfer/io/evidence/json/shared_fields.hpp"

namespace kinfer::evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, Envelope>& envelope) {
  a.plotted_list("low", envelope.low);
  a.plotted_list("high", envelope.high);
}

template <class Archive>
void fields(Archive& a, Value<Archive, Trace>& trace) {
  a("sensor", trace.sensor);
  a("quantity", trace.quantity);
  std::string trace_unit(unit(trace.quantity));
  a("unit", trace_unit);
  a("frame", trace.frame);
  a.later("rms_measured", trace.rms_measured);
  a.later("rms_fitted", trace.rms_fitted);
  a.later("rms_holdout", trace.rms_holdout);
  a("measured", trace.measured);
  a("predicted", trace.predicted);
  a("residual", trace.residual);
}

/// [begin, end]
template <class Archive>
void window_fields(Archive& a, Value<Archive, std::vector<TimeWindow>>& windows) {
  std::vector<std::array<double, 2>> pairs;
  for (const TimeWindow& window : windows) pairs.push_back({window.begin, window.end});
  a("held_out", pairs);
  if constexpr (!Archive::is_writer) {
    windows.clear();
    for (const auto& [begin, end] : pairs) windows.push_back({begin, end});
  }
}

template <class Archive>
void fields(Archive& a, Value<Archive, MachineTrajectory>& trajectory) {
  a("time", trajectory.time);
  a("root", trajectory.root);
  a.matrix_columns("q", trajectory.q);
}

/// Every envelope has one value for each time.
inline void check_lengths(JsonReader& a, const MotionEvidence& motion) {
  for (const Trace& trace : motion.traces)
    for (const auto* signal : {&trace.measured, &trace.predicted, &trace.residual})
      for (const Envelope& envelope : *signal)
        if (envelope.low.size() != motion.time.size() || envelope.high.size() != motion.time.size())
          return a.error("traces", "expected as many values as times");
}
inline void check_lengths(auto&, const MotionEvidence&) {}

template <class Archive>
void fields(Archive& a, Value<Archive, MotionEvidence>& motion) {
  a("time", motion.time);
  window_fields(a, motion.held_out);
  a("traces", motion.traces);
  a("playback", motion.trajectory);
  check_lengths(a, motion);
}

}  // namespace kinfer::evidence_json
