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

/// Σ ln of the sensors' acceleration residuals, in held-out windows if there are any: nats a row and component.
double log_residuals(const MotionEvidence& motion) {
  double sum = 0.0;
  for (const Trace& trace : motion.traces) {
    if (trace.quantity != TraceQuantity::acceleration) continue;
    const double rms = motion.held_out.empty() ? trace.rms_fitted : trace.rms_holdout;
    sum += std::log(std::max(rms, pair_acceleration_floor));
  }
  return sum;
}

}  // namespace

bool contradicts_given_links(const Identification& given) {
  return std::ranges::any_of(given.findings, is_contradicted_link);
}

void weigh_given_links(Identification& given, const Identification& estimated) {
  if (log_residuals(given.motion) - log_residuals(estimated.motion) > decisive_link_gap) return;
  for (Finding& finding : given.findings)
    if (is_contradicted_link(finding)) finding.severity = Severity::note;
}

}  // namespace kinfer::identify
