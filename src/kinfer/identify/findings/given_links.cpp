// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/given_links.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/structure/thresholds.hpp"

namespace kinfer::identify {
namespace {

bool is_contradicted_link(const Finding& finding) {
  return finding.kind == FindingKind::given_link && invalidates_result(finding);
}

double log_residual(const MotionEvidence& motion, const Trace& trace) {
  return std::log(std::max(motion.held_out.empty() ? trace.rms_fitted : trace.rms_holdout, pair_acceleration_floor));
}

/// Σ ln of the sensors' acceleration residuals, in held-out windows if there are any, of the first motion less the
/// second, over the sensors of both: nats a row and component.
double log_residuals_beyond(const MotionEvidence& motion, const MotionEvidence& other) {
  double sum = 0.0;
  for (const Trace& trace : motion.traces) {
    if (trace.quantity != TraceQuantity::acceleration) continue;
    const auto same = std::ranges::find_if(other.traces, [&](const Trace& t) {
      return t.quantity == TraceQuantity::acceleration && t.sensor == trace.sensor;
    });
    if (same != other.traces.end()) sum += log_residual(motion, trace) - log_residual(other, *same);
  }
  return sum;
}

}  // namespace

bool contradicts_given_links(const Identification& given) {
  return std::ranges::any_of(given.findings, is_contradicted_link);
}

void weigh_given_links(Identification& given, const Identification& estimated) {
  if (log_residuals_beyond(given.motion, estimated.motion) > decisive_link_gap) return;
  for (Finding& finding : given.findings)
    if (is_contradicted_link(finding)) finding.severity = Severity::note;
}

}  // namespace kinfer::identify
