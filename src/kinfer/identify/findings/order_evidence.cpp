// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/order_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/findings/thresholds.hpp"
#include "kinfer/identify/loops/loop_estimate.hpp"
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

}  // namespace

std::vector<PairFit> closing_pairs(const OrderedMotion& ordered, const std::vector<LoopEstimate>& loops) {
  const std::vector<std::string> names = segment_names(ordered.motion);
  const auto index = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  std::vector<PairFit> pairs;
  for (const LoopEstimate& loop : loops)
    pairs.push_back(ordered.tree.pair(index(loop.joint.parent), index(loop.joint.child)));
  return pairs;
}

OrderReport report_order(const OrderedMotion& ordered, const std::vector<LoopEstimate>& loops) {
  OrderReport report{.evidence = order_evidence(ordered, closing_pairs(ordered, loops)),
                     .notes = {},
                     .findings = loop_findings(loops)};
  report.notes = order_notes(report.evidence);
  std::ranges::copy(ordered.findings, std::back_inserter(report.findings));
  return report;
}

}  // namespace kinfer::identify
