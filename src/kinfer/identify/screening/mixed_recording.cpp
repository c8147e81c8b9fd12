// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/mixed_recording.hpp"

#include <algorithm>
#include <array>

#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/screening/thresholds.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer::identify {
namespace {

struct Span {
  double begin = 0.0, end = 0.0;  // [s]
};

Span span_of(const InsRecording& recording) {
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const InsLogger& logger : recording.loggers) {
    if (logger.time.empty()) continue;
    span.begin = std::min(span.begin, logger.time.front()), span.end = std::max(span.end, logger.time.back());
  }
  return span;
}

/// [nats per row] of the joints of `tree`, by the pairs of `part`.
double length_of(const SegmentTree& tree, const OrderedMotion& part) {
  double length = 0.0;
  for (std::size_t child = 0; child < tree.parent.size(); ++child)
    if (tree.parent[child]) length += part.tree.pair(*tree.parent[child], child).distance;
  return length;
}

bool is_connected(const OrderedMotion& part, std::size_t a, std::size_t b) {
  const auto strength = strength_of(pair_connection(part.motion, a, b).whole);
  return strength == ConnectionStrength::strong || strength == ConnectionStrength::weak;
}

/// Whether `segment` has a joint in `part` that it does not have in `other`.
bool has_other_joint(std::size_t segment, const OrderedMotion& part, const OrderedMotion& other) {
  for (std::size_t s = 0; s < part.tree.parent.size(); ++s)
    if (s != segment && is_edge(part.tree, segment, s) && !is_edge(other.tree, segment, s) &&
        is_connected(part, segment, s))
      return true;
  return false;
}

/// A joint of `part` that the pair does not have in `other`, where one of the two has another joint instead (a fit that
/// fails has none). The joints of `other` must be none for `part` either: segments between which nothing moves may be
/// exchanged in a tree.
bool has_lost_joint(const OrderedMotion& part, const OrderedMotion& other) {
  if (length_of(other.tree, part) - length_of(part.tree, part) < lost_joint_distance) return false;
  for (const std::size_t child : part.tree.order) {
    if (!part.tree.parent[child]) continue;
    const std::size_t parent = *part.tree.parent[child];
    if (is_edge(other.tree, parent, child)) continue;
    const double lost = other.tree.pair(parent, child).distance - part.tree.pair(parent, child).distance;
    if (lost > lost_joint_distance &&
        strength_of(pair_connection(part.motion, parent, child).whole) == ConnectionStrength::strong &&
        (has_other_joint(parent, other, part) || has_other_joint(child, other, part)))
      return true;
  }
  return false;
}

/// Times by which the two parts are separated: where a remounted sensor changed, else in the middle.
double cut_of(const RecordingSelection& part, const InsRecording& recording) {
  for (const Finding& finding : part.findings)
    if (finding.kind == FindingKind::remounted)
      return 0.5 * (finding.values.number("begin") + finding.values.number("end"));
  const Span whole = span_of(recording);
  return 0.5 * (whole.begin + whole.end);
}

std::vector<std::string> sensors_of(const Finding& finding) {
  switch (finding.kind) {
    case FindingKind::remounted:
    case FindingKind::no_joint:
    case FindingKind::linkage:
    case FindingKind::not_connected:
      return {finding.values.text("sensor")};
    case FindingKind::several_machines:
      return finding.values.has("sensors") ? finding.values.texts("sensors") : std::vector<std::string>{};
    default:
      return {};
  }
}

}  // namespace

std::optional<MixedPart> find_mixed_part(const InsRecording& recording, double cut, const SegmentMotionOptions& options,
                                         int threads) {
  const Span whole = span_of(recording);
  const std::array<Span, 2> spans{Span{whole.begin, cut}, Span{cut, whole.end}};
  std::vector<OrderedMotion> parts;
  for (const Span& span : spans) {
    if (span.end - span.begin < min_connection_time) return std::nullopt;
    auto ordered = order_segments(within(recording, span.begin, span.end), options, std::nullopt, threads);
    if (!ordered) return std::nullopt;  // at rest: nothing is known of that part
    parts.push_back(std::move(*ordered));
  }
  for (const std::size_t k : {0, 1})
    if (has_lost_joint(parts[k], parts[1 - k])) return MixedPart{spans[k].begin, spans[k].end};
  return std::nullopt;
}

void name_mixed_recording(RecordingSelection& part, const InsRecording& recording, const SegmentMotionOptions& options,
                          int threads) {
  if (std::ranges::all_of(part.findings, [](const Finding& f) { return sensors_of(f).empty(); })) return;
  const auto mixed = find_mixed_part(recording, cut_of(part, recording), options, threads);
  if (!mixed) return;
  std::vector<Finding> findings;
  for (Finding& finding : part.findings) {
    const auto sensors = sensors_of(finding);
    if (sensors.empty()) findings.push_back(std::move(finding));
    for (const std::string& sensor : sensors)
      findings.push_back({.kind = FindingKind::mixed_recording,
                          .severity = Severity::fault,
                          .values = {{"sensor", sensor}, {"begin", mixed->begin}, {"end", mixed->end}}});
  }
  part.findings = std::move(findings);
}

}  // namespace kinfer::identify
