// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/verdict.hpp"

#include <algorithm>

namespace kinfer::identify {
namespace {

bool has_doubt(const JointVerdict& joint, JointDoubtKind kind) {
  return std::ranges::find(joint.doubts, kind, &JointDoubt::kind) != joint.doubts.end();
}

}  // namespace

PredictionSummary summarise_prediction(const MotionEvidence& motion) {
  PredictionSummary summary;
  for (const TimeWindow& window : motion.held_out) summary.held_out_seconds += window.end - window.begin;
  double Trace::*const rms = summary.held_out_seconds > 0.0 ? &Trace::rms_holdout : &Trace::rms_fitted;
  for (const Trace& trace : motion.traces)
    if (trace.quantity == TraceQuantity::acceleration)
      summary.worst_acceleration = std::max(summary.worst_acceleration, trace.*rms);
  return summary;
}

Usability usability(const std::vector<Finding>& findings, const std::vector<JointEstimate>& joints,
                    const std::vector<JointVerdict>& verdicts) {
  const auto some = [&](JointUsability u) {
    return std::ranges::find(verdicts, u, &JointVerdict::usability) != verdicts.end();
  };
  if (std::ranges::any_of(findings, invalidates_result) || some(JointUsability::do_not_use))
    return Usability::do_not_use;
  const bool is_all_doubtful = std::ranges::all_of(verdicts, [](const JointVerdict& joint) {
    return joint.usability == JointUsability::unknown || has_doubt(joint, JointDoubtKind::weakly_connected);
  });
  if (is_all_doubtful && !verdicts.empty()) return Usability::do_not_use;
  const bool is_undetermined = std::ranges::any_of(
      verdicts, [](const JointVerdict& joint) { return has_doubt(joint, JointDoubtKind::undetermined); });
  const bool is_questioned = some(JointUsability::use_with_care) || is_undetermined ||
                             std::ranges::any_of(findings, questions_result) ||
                             probability_of_types(joints) < wanted_confidence;
  return is_questioned ? Usability::use_with_care : Usability::use;
}

}  // namespace kinfer::identify
