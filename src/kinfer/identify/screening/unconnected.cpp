// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/unconnected.hpp"

#include <algorithm>
#include <numeric>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/screening/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Segments = std::vector<std::size_t>;

bool is_no_connection(const PairConnection& pair) {
  return strength_of(pair.whole) == ConnectionStrength::none || only_connected_part(pair);
}

/// Segments that the connections join, one list for each group.
std::vector<Segments> connected_groups(std::size_t segments, const std::vector<PairConnection>& connections) {
  Segments label(segments);
  std::iota(label.begin(), label.end(), std::size_t{0});
  for (const PairConnection& pair : connections) {
    if (is_no_connection(pair)) continue;
    const std::size_t from = label[pair.child], to = label[pair.parent];
    std::ranges::replace(label, from, to);
  }
  std::vector<Segments> groups;
  for (std::size_t g = 0; g < segments; ++g) {
    Segments members;
    for (std::size_t s = 0; s < segments; ++s)
      if (label[s] == g) members.push_back(s);
    if (!members.empty()) groups.push_back(members);
  }
  return groups;
}

const Segments& chosen_group(const std::vector<Segments>& groups, const RecordedMotion& motion,
                             const std::optional<std::string>& root) {
  for (const Segments& group : groups)
    if (root && group.size() > 1 &&
        std::ranges::any_of(group, [&](std::size_t s) { return motion.segments[s].name == *root; }))
      return group;
  return *std::ranges::max_element(groups, {}, &Segments::size);
}

/// The segments whose motion explains that of one best, in the order of the sensors.
Segments nearest_segments(const SegmentTree& tree, std::size_t segment, std::size_t segments) {
  Segments others;
  for (std::size_t s = 0; s < segments; ++s)
    if (s != segment) others.push_back(s);
  std::ranges::stable_sort(others, {}, [&](std::size_t s) { return tree.pair(segment, s).distance; });
  if (others.size() > max_partners) others.resize(max_partners);
  std::ranges::sort(others);
  return others;
}

/// Where a segment is connected with one of the nearest others in a part of the recording only. A joint of half of the
/// recording leaves less than none at all; all pairs of 60 sensors would take minutes.
std::optional<PartConnection> connected_part(const OrderedMotion& ordered, std::size_t segment, int threads) {
  const Segments others = nearest_segments(ordered.tree, segment, ordered.motion.segments.size());
  std::vector<PairConnection> pairs(others.size());
  parallel_for(pairs.size(), threads,
               [&](std::size_t i) { pairs[i] = pair_connection(ordered.motion, others[i], segment); });
  for (const PairConnection& pair : pairs)
    if (const auto part = only_connected_part(pair)) return part;
  return std::nullopt;
}

Finding mixed_finding(const std::string& sensor, const PartConnection& part) {
  return {.kind = FindingKind::mixed_recording,
          .severity = Severity::fault,
          .values = {{"sensor", sensor}, {"begin", part.begin}, {"end", part.end}}};
}

/// `is_minority`: the machine that is left has fewer than half of the sensors.
Finding stranger_finding(const std::string& sensor, bool is_minority) {
  return {.kind = FindingKind::not_connected,
          .severity = is_minority ? Severity::fault : Severity::warning,
          .values = {{"sensor", sensor}},
          .applied = !is_minority};
}

/// A group that is connected within itself.
Finding machine_finding(const OrderedMotion& ordered, const Segments& group,
                        const std::vector<PairConnection>& connections) {
  const auto is_in = [&](std::size_t s) { return std::ranges::find(group, s) != group.end(); };
  std::vector<double> residuals;
  const PairConnection* link = nullptr;  // the best one from the group to the others
  for (const PairConnection& pair : connections) {
    if (!is_no_connection(pair)) residuals.push_back(pair.whole.residual);
    if (is_in(pair.parent) != is_in(pair.child) && (!link || pair.whole.residual < link->whole.residual)) link = &pair;
  }
  const auto& segments = ordered.motion.segments;
  std::vector<std::string> names;
  for (const std::size_t s : group) names.push_back(segments[s].name);
  return {.kind = FindingKind::several_machines,
          .severity = Severity::warning,
          .values = {{"sensors", names},
                     {"link", segments[link->parent].name + "-" + segments[link->child].name},
                     {"residual", link->whole.residual},
                     {"usual_residual", median(residuals)}},
          .applied = true};
}

/// About a group that is left out.
std::vector<Finding> findings_about(const OrderedMotion& ordered, const Segments& group,
                                    const std::vector<PairConnection>& connections, bool is_minority, int threads) {
  std::vector<Finding> mixed, strangers;
  for (const std::size_t s : group) {
    const std::string& name = ordered.motion.segments[s].name;
    if (const auto part = connected_part(ordered, s, threads))
      mixed.push_back(mixed_finding(name, *part));
    else
      strangers.push_back(stranger_finding(name, is_minority));
  }
  if (mixed.empty() && group.size() > 1) return {machine_finding(ordered, group, connections)};
  std::ranges::move(strangers, std::back_inserter(mixed));
  return mixed;
}

}  // namespace

bool is_unconnected(const std::vector<PairConnection>& connections) {
  return !connections.empty() && std::ranges::all_of(connections, is_no_connection);
}

bool has_certain_joint(const std::vector<PairConnection>& connections) {
  return std::ranges::any_of(connections, [](const PairConnection& pair) {
    const auto strength = strength_of(pair.whole);
    return strength == ConnectionStrength::strong || strength == ConnectionStrength::unexcited;
  });
}

RecordingSelection select_connected(const OrderedMotion& ordered, const std::vector<PairConnection>& connections,
                                    const std::optional<std::string>& root, int threads) {
  const RecordedMotion& motion = ordered.motion;
  RecordingSelection chosen = select_all(motion.segments.size());
  if (is_unconnected(connections) || std::ranges::none_of(connections, is_no_connection)) return chosen;
  const auto groups = connected_groups(motion.segments.size(), connections);
  chosen.sensors = chosen_group(groups, motion, root);
  const bool is_minority = 2 * chosen.sensors.size() < motion.segments.size();
  for (const Segments& group : groups)
    if (group != chosen.sensors)
      std::ranges::move(findings_about(ordered, group, connections, is_minority, threads),
                        std::back_inserter(chosen.findings));
  return chosen;
}

}  // namespace kinfer::identify
