// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/verdict.hpp"

#include <algorithm>

namespace kinfer::identify {

PredictionSummary summarise_prediction(const MotionEvidence& motion) {
  PredictionSummary summary;
  for (const TimeWindow& window : motion.held_out) summary.held_out_seconds += window.end - window.begin;
  double Trace::*const rms = summary.held_out_seconds > 0.0 ? &Trace::rms_holdout : &Trace::rms_fitted;
  for (const Trace& trace : motion.traces)
    if (trace.quantity == TraceQuantity::acceleration)
      summary.worst_acceleration = std::max(summary.worst_acceleration, trace.*rms);
  return summary;
}

Usability usability(const std::vector<Finding>& findings, const std::vector<JointForecast>& forecast) {
  if (std::ranges::any_of(findings, invalidates_result)) return Usability::do_not_use;
  return all_sufficient(forecast) ? Usability::use : Usability::use_with_care;
}

}  // namespace kinfer::identify
