// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/order_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/findings/thresholds.hpp"
#include "kinfer/identify/screening/loops.hpp"
#include "kinfer/identify/structure/moving_phases.hpp"

namespace kinfer::identify {
namespace {

OrderEvidence order_evidence(const OrderedMotion& ordered, const std::vector<PairFit>& closing_pairs) {
  const SegmentTree& tree = ordered.tree;
  const MovingPhases phases = moving_phases(ordered.motion);
  OrderEvidence order{.sensors = segment_names(ordered.motion),
                      .pairs = {},
                      .phases = {},
                      .rank = phases.rank,
                      .phases_agree = has_same_parents(phases, tree)};
  if (const double margin = margin_of(tree, closing_pairs); std::isfinite(margin)) order.margin = margin;
  for (const PairFit& pair : tree.pairs)
    order.pairs.push_back({order.sensors[pair.first], order.sensors[pair.second], pair.residual(), pair.off_axis_rate(),
                           pair.distance, is_edge(tree, pair.first, pair.second)});
  for (const MovingPhase& phase : phases.phases) order.phases.push_back({phase.begin, phase.end, phase.moves});
  return order;
}

std::vector<IdentificationNote> order_notes(const OrderEvidence& order) {
  std::vector<IdentificationNote> notes;
  if (order.margin && *order.margin < safe_margin)
    notes.push_back({IdentificationNoteKind::unsafe_order, {{"margin", *order.margin}, {"safe_margin", safe_margin}}});
  if (!order.phases_agree) notes.push_back({IdentificationNoteKind::phases_disagree, {}});
  return notes;
}

/// Pairs whose loop has no sensor that clips: restored peaks leave residuals in some pairs and not in others, which is
/// what a loop looks like.
std::vector<PairFit> without_clipped_sensors(std::vector<PairFit> closing, const OrderedMotion& ordered) {
  const auto clips = [&](std::size_t segment) { return ordered.motion.segments[segment].clips; };
  std::erase_if(closing, [&](const PairFit& pair) {
    return std::ranges::any_of(path_between(ordered.tree, pair.first, pair.second),
                               [&](const auto& edge) { return clips(edge.first) || clips(edge.second); });
  });
  return closing;
}

}  // namespace

OrderReport report_order(const OrderedMotion& ordered, TreeOrigin origin) {
  const auto closing_pairs = origin == TreeOrigin::estimated
                                 ? without_clipped_sensors(loop_closing_pairs(ordered.tree), ordered)
                                 : std::vector<PairFit>{};
  OrderReport report{.evidence = order_evidence(ordered, closing_pairs),
                     .notes = {},
                     .findings = loop_findings(ordered.tree, closing_pairs, segment_names(ordered.motion))};
  report.notes = order_notes(report.evidence);
  std::ranges::copy(ordered.findings, std::back_inserter(report.findings));
  return report;
}

}  // namespace kinfer::identify
