// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/joint_verdicts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinfer/identify/findings/order_evidence.hpp"
#include "kinfer/identify/findings/thresholds.hpp"
#include "kinfer/identify/screening/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Doubts = std::vector<JointDoubt>;

void doubt_connection(const PairConnection& connection, Doubts& doubts) {
  const FactValues gain{{"gain", connection.whole.gain()}, {"needed", strong_connection_gain}};
  if (const auto part = only_connected_part(connection))
    doubts.push_back({JointDoubtKind::partly_connected, {{"begin", part->begin}, {"end", part->end}}});
  else if (strength_of(connection.whole) == ConnectionStrength::none)
    doubts.push_back({JointDoubtKind::not_connected, gain});
  else if (strength_of(connection.whole) != ConnectionStrength::strong)  // weak, or too little moved for any evidence
    doubts.push_back({JointDoubtKind::weakly_connected, gain});
  if (has_changed(connection)) doubts.push_back({JointDoubtKind::changed, {}});
}

/// Of a sensor that is connected with the others in a part of the recording only, nothing tells which joint is the
/// machine's.
void doubt_mixed_sensors(const Identification& result, const JointEstimate& joint, Doubts& doubts) {
  const bool is_mixed = std::ranges::any_of(result.findings, [&](const Finding& finding) {
    if (finding.kind != FindingKind::mixed_recording) return false;
    const std::string& sensor = finding.values.text("sensor");
    return sensor == joint.parent || sensor == joint.child;
  });
  const bool is_said =
      std::ranges::any_of(doubts, [](const JointDoubt& doubt) { return doubt.kind == JointDoubtKind::changed; });
  if (is_mixed && !is_said) doubts.push_back({JointDoubtKind::changed, {}});
}

/// Distance of a point from the sensor's origin across the directions that the recording does not determine.
double known_distance(Vec3 point, const std::vector<Vec3>& unobservable) {
  for (const Vec3& direction : unobservable) point -= direction * direction.dot(point);
  return point.norm();
}

void doubt_reach(const JointEstimate& joint, Doubts& doubts) {
  const double in_parent = known_distance(joint.point_in_parent, joint.unobservable_in_parent),
               in_child = known_distance(joint.point_in_child, joint.unobservable_in_child);
  const double distance = std::max(in_parent, in_child);
  if (std::isfinite(distance) && distance <= max_reach) return;
  doubts.push_back(
      {JointDoubtKind::beyond_reach,
       {{"sensor", in_parent > in_child ? joint.parent : joint.child}, {"distance", distance}, {"reach", max_reach}}});
}

/// The pair outside the tree that would replace this link at the least cost.
struct Rival {
  const PairFit* pair = nullptr;
  double gap = std::numeric_limits<double>::infinity();  // [nats per row]
};

Rival rival_of(const SegmentTree& tree, const PairFit& link, const std::vector<PairFit>& closing) {
  Rival best;
  for (const PairFit& pair : tree.pairs) {
    const auto is_this = [&](const PairFit& c) { return c.first == pair.first && c.second == pair.second; };
    if (is_edge(tree, pair.first, pair.second) || std::ranges::any_of(closing, is_this)) continue;
    for (const auto& [a, b] : path_between(tree, pair.first, pair.second))
      if (&tree.pair(a, b) == &link && pair.distance - link.distance < best.gap)
        best = {&pair, pair.distance - link.distance};
  }
  return best;
}

void doubt_order(const OrderedMotion& ordered, const PairFit& link, const std::vector<LoopEstimate>& loops,
                 Doubts& doubts) {
  const Rival rival = rival_of(ordered.tree, link, closing_pairs(ordered, loops));
  if (!rival.pair || std::exp(rival.gap) >= safe_margin) return;
  doubts.push_back({JointDoubtKind::unsafe_order,
                    {{"first", ordered.motion.segments[rival.pair->first].name},
                     {"second", ordered.motion.segments[rival.pair->second].name},
                     {"margin", std::exp(rival.gap)},
                     {"safe_margin", safe_margin}}});
}

/// The search takes no error but noise into account.
void doubt_fit(const Identification& result, Doubts& doubts) {
  if (std::ranges::find(result.notes, IdentificationNoteKind::refinement_failed, &IdentificationNote::kind) !=
      result.notes.end())
    doubts.push_back({JointDoubtKind::not_fitted, {}});
}

void doubt_residuals(const Identification& result, const JointEstimate& joint, Doubts& doubts) {
  for (const IdentificationNote& note : result.notes) {
    if (note.kind != IdentificationNoteKind::unexplained_motion) continue;
    const std::string& sensor = note.values.text("sensor");
    if (sensor != joint.parent && sensor != joint.child) continue;
    doubts.push_back({JointDoubtKind::unexplained_motion,
                      {{"sensor", sensor},
                       {"ratio", std::max(note.values.number("force_ratio"), note.values.number("rate_ratio"))}}});
    return;
  }
}

/// Types that are not possible at the wanted confidence are those that together have the rest of the probability.
void doubt_type(const JointEstimate& joint, Doubts& doubts) {
  if (type_probability(joint) >= wanted_confidence) return;
  std::vector<std::pair<double, EstimatedJointType>> types;
  for (std::size_t i = 0; i < joint.type_probabilities->of_type.size(); ++i)
    types.emplace_back(joint.type_probabilities->of_type[i], static_cast<EstimatedJointType>(i));
  std::ranges::sort(types, std::greater{});
  std::vector<std::string> names;
  std::vector<double> probabilities;
  for (double sum = 0.0; const auto& [probability, type] : types) {
    if (sum >= wanted_confidence) break;
    sum += probability;
    names.emplace_back(name(type));
    probabilities.push_back(probability);
  }
  doubts.push_back({JointDoubtKind::uncertain_type, {{"types", names}, {"probabilities", probabilities}}});
}

void doubt_accuracy(const Identification& result, const JointEstimate& joint, Doubts& doubts) {
  const auto forecast = std::ranges::find(result.forecast, joint_name(joint), &JointForecast::joint);
  if (forecast == result.forecast.end() || forecast->is_sufficient) return;
  if (!is_determined(*forecast)) return doubts.push_back({JointDoubtKind::undetermined, {}});
  doubts.push_back(
      {JointDoubtKind::inaccurate, {{"line_sd", forecast->line_sd}, {"direction_sd", forecast->direction_sd}}});
}

JointUsability usability_of(const Doubts& doubts) {
  const auto has = [&](JointDoubtKind kind) {
    return std::ranges::find(doubts, kind, &JointDoubt::kind) != doubts.end();
  };
  for (const JointDoubtKind kind : {JointDoubtKind::not_connected, JointDoubtKind::partly_connected,
                                    JointDoubtKind::changed, JointDoubtKind::beyond_reach})
    if (has(kind)) return JointUsability::do_not_use;
  if (has(JointDoubtKind::not_moved)) return JointUsability::unknown;
  // One doubt alone has happened on sound machines; an uncertain connection that also leaves the order open has not.
  if (has(JointDoubtKind::weakly_connected) && has(JointDoubtKind::unsafe_order)) return JointUsability::do_not_use;
  if (has(JointDoubtKind::undetermined)) return JointUsability::unknown;
  return doubts.empty() ? JointUsability::use : JointUsability::use_with_care;
}

std::size_t index_named(const RecordedMotion& motion, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(motion.segments, name, &SegmentMotion::name) -
                                  motion.segments.begin());
}

JointVerdict verdict_on(const JointEstimate& joint, const Identification& result, const OrderedMotion& ordered,
                        const std::vector<PairConnection>& connections) {
  const std::size_t parent = index_named(ordered.motion, joint.parent),
                    child = index_named(ordered.motion, joint.child);
  JointVerdict verdict{.joint = joint_name(joint)};
  const auto connection = std::ranges::find(connections, child, &PairConnection::child);
  if (connection != connections.end()) {
    verdict.connection = connection->whole;
    doubt_connection(*connection, verdict.doubts);
  }
  doubt_mixed_sensors(result, joint, verdict.doubts);
  if (joint.type == EstimatedJointType::rigid)
    verdict.doubts.push_back({JointDoubtKind::not_moved, {}});
  else
    doubt_reach(joint, verdict.doubts);
  doubt_order(ordered, ordered.tree.pair(parent, child), result.loops, verdict.doubts);
  doubt_type(joint, verdict.doubts);
  doubt_fit(result, verdict.doubts);
  doubt_residuals(result, joint, verdict.doubts);
  doubt_accuracy(result, joint, verdict.doubts);
  verdict.usability = usability_of(verdict.doubts);
  return verdict;
}

bool is_unconnected(const JointVerdict& verdict) {
  return std::ranges::any_of(verdict.doubts, [](const JointDoubt& doubt) {
    return doubt.kind == JointDoubtKind::not_connected || doubt.kind == JointDoubtKind::partly_connected ||
           doubt.kind == JointDoubtKind::changed;
  });
}

void make_unknown(JointStandardDeviation& sd) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  for (auto* both : {&sd.axis_in_parent, &sd.axis_in_child, &sd.point_in_parent, &sd.point_in_child})
    both->fill(unknown);
  sd.along_axis = unknown;
}

}  // namespace

void withdraw_unconnected(Identification& result) {
  for (std::size_t i = 0; i < result.joints.size(); ++i) {
    if (!is_unconnected(result.verdicts[i])) continue;
    const std::string joint = joint_name(result.joints[i]);
    make_unknown(result.joints[i].sd);
    std::erase_if(result.forecast, [&](const JointForecast& f) { return f.joint == joint; });
    std::erase_if(result.links, [&](const LinkEstimate& link) { return link.from == joint || link.to == joint; });
    constexpr double unknown = std::numeric_limits<double>::infinity();
    for (DhRowEstimate& row : result.dh)
      if (row.segment == result.joints[i].child)
        for (double DhNumbers::*number : {&DhNumbers::theta, &DhNumbers::d, &DhNumbers::a, &DhNumbers::alpha})
          row.sd.*number = unknown;
  }
}

std::vector<JointVerdict> joint_verdicts(const Identification& result, const OrderedMotion& ordered,
                                         const std::vector<PairConnection>& connections) {
  std::vector<JointVerdict> verdicts;
  for (const JointEstimate& joint : result.joints) verdicts.push_back(verdict_on(joint, result, ordered, connections));
  return verdicts;
}

}  // namespace kinfer::identify
