// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/machines.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/screening/thresholds.hpp"
#include "kinfer/identify/structure/slide_fit.hpp"
#include "kinfer/inertial/rest/slow_motion.hpp"
#include "kinfer/inertial/rest/steady_rotation.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr double averaging_time = 0.1;     // [s] averaging time against noise
constexpr std::size_t min_tree_links = 3;  // that say what is usual

/// Rms deviation of a sensor's averaged measurements from their mean.
template <class Pick>
double deviation_from_mean(const InsSensor& sensor, std::span<const double> time, const Pick& pick) {
  std::vector<Vec3> means;
  Vec3 sum = Vec3::Zero(), all = Vec3::Zero();
  double n = 0.0, begin = time.empty() ? 0.0 : time.front();
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (const auto value = pick(sample(sensor, time, row))) sum += *value, n += 1.0;
    if (time[row] - begin < averaging_time) continue;
    if (n > 0.0) means.push_back(sum / n), all += means.back();
    sum.setZero(), n = 0.0, begin = time[row];
  }
  double square = 0.0;
  for (const Vec3& mean : means) square += (mean - all / static_cast<double>(means.size())).squaredNorm();
  return means.empty() ? 0.0 : std::sqrt(square / static_cast<double>(means.size()));
}

bool is_stationary(const InsSensor& sensor, std::span<const double> time, const SegmentMotionOptions& options,
                   std::span<const RestPeriod> rests) {
  return deviation_from_mean(sensor, time,
                             [](const InsSample& s) {
                               return s.has_angular_velocity ? std::optional<Vec3>(s.angular_velocity) : std::nullopt;
                             }) < options.stationary_rate &&
         deviation_from_mean(sensor, time,
                             [](const InsSample& s) {
                               return s.has_acceleration ? std::optional<Vec3>(s.acceleration) : std::nullopt;
                             }) < options.stationary_acceleration &&
         !moves_slowly(sensor, time, rests);
}

std::vector<std::string> names_of(const RecordedMotion& motion, const std::vector<std::size_t>& segments) {
  std::vector<std::string> names;
  for (const std::size_t s : segments) names.push_back(motion.segments[s].name);
  return names;
}

/// [m/s²] Acceleration residual of a link. If the two segments hardly rotate relative to each other, only what a
/// prismatic joint leaves: across the direction of the largest residual, or beyond Coriolis accelerations of the slide.
double misfit(const RecordedMotion& motion, const PairFit& pair, std::size_t parent, std::size_t child) {
  if (pair.relative_rate() > min_rotating_rate) return pair.residual();
  const double across = std::sqrt(std::max(0.0, symmetric_eigen(pair.acceleration).values[1]));
  if (across < part_threshold.residual) return across;
  const auto slide = fit_slide(motion, motion.segments[parent], motion.segments[child]);
  return slide ? std::min(across, slide->residual) : across;
}

struct TreeLink {
  std::size_t parent, child;
  double misfit;
  bool rotates;
};

std::vector<TreeLink> links_of(const OrderedMotion& ordered) {
  const SegmentTree& tree = ordered.tree;
  std::vector<TreeLink> links;
  for (const std::size_t child : tree.order)
    if (tree.parent[child]) {
      const PairFit& pair = tree.pair(*tree.parent[child], child);
      links.push_back({*tree.parent[child], child, misfit(ordered.motion, pair, *tree.parent[child], child),
                       pair.relative_rate() > min_rotating_rate});
    }
  return links;
}

/// Of the joints that rotate, where there are some: two sensors on one segment leave less than any joint.
double usual_misfit(const std::vector<TreeLink>& links) {
  std::vector<double> all, rotating;
  for (const TreeLink& link : links) {
    all.push_back(link.misfit);
    if (link.rotates) rotating.push_back(link.misfit);
  }
  return median(rotating.size() >= min_tree_links ? rotating : all);
}

/// Connected groups of segments by the links that are kept, each in the order of the sensors.
std::vector<std::vector<std::size_t>> groups_of(std::size_t segments, const std::vector<TreeLink>& kept) {
  std::vector<std::size_t> group(segments);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const TreeLink& link : kept) {
    const std::size_t from = group[link.child], to = group[link.parent];
    std::ranges::replace(group, from, to);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t g = 0; g < segments; ++g) {
    std::vector<std::size_t> members;
    for (std::size_t s = 0; s < segments; ++s)
      if (group[s] == g) members.push_back(s);
    if (!members.empty()) groups.push_back(members);
  }
  return groups;
}

/// Number of segments in the smaller part if the tree is cut at a link.
std::size_t smaller_part(const SegmentTree& tree, const TreeLink& link) {
  std::size_t beyond = 0;
  for (std::size_t s = 0; s < tree.parent.size(); ++s)
    for (std::optional<std::size_t> at = s; at; at = tree.parent[*at])
      if (*at == link.child) {
        ++beyond;
        break;
      }
  return std::min(beyond, tree.parent.size() - beyond);
}

bool is_no_joint(const SegmentTree& tree, const TreeLink& link, double median_misfit) {
  const NoJointThreshold& limit = smaller_part(tree, link) >= 3 ? machine_threshold : part_threshold;
  return link.misfit > std::max(limit.residual, limit.factor * median_misfit);
}

Finding separation_finding(const OrderedMotion& ordered, const TreeLink& cut, const std::vector<std::size_t>& excluded,
                           double median_misfit) {
  const auto names = names_of(ordered.motion, excluded);
  const PairFit& pair = ordered.tree.pair(cut.parent, cut.child);
  const bool is_alone = excluded.size() == 1;
  const bool rotates_about_one_axis = pair.off_axis_rate() < max_revolute_off_axis_share * pair.relative_rate();
  Finding finding{
      .kind = !is_alone                ? FindingKind::several_machines
              : rotates_about_one_axis ? FindingKind::linkage
                                       : FindingKind::no_joint,
      .severity = Severity::warning,
      .values = {{"link", ordered.motion.segments[cut.parent].name + "-" + ordered.motion.segments[cut.child].name},
                 {"residual", pair.residual()},
                 {"usual_residual", median_misfit}},
      .applied = true};
  if (is_alone)
    finding.values.set("sensor", names.front());
  else
    finding.values.set("sensors", names);
  return finding;
}

/// [nats per row] Of a link whose segments do not move as if they had nothing to do with each other.
std::optional<double> connection_gain(std::span<const PairConnection> connections, const TreeLink& link) {
  for (const PairConnection& pair : connections) {
    const bool is_link = pair.parent == link.parent && pair.child == link.child;
    const auto strength = strength_of(pair.whole);
    if (is_link && (strength == ConnectionStrength::weak || strength == ConnectionStrength::strong))
      return pair.whole.gain();
  }
  return std::nullopt;
}

/// [s] of a segment's measurements between its gaps, on the average.
double mean_piece(const RecordedMotion& motion, std::size_t segment) {
  const auto usable = static_cast<double>(std::ranges::count(motion.usable, true));
  return usable * motion.period / static_cast<double>(motion.segments[segment].restarts.size() + 1);
}

/// The sensor with the shortest pieces of those beside the cuts, where they are too short.
std::optional<std::size_t> fragmented_segment(const RecordedMotion& motion, const std::vector<TreeLink>& cut) {
  std::optional<std::size_t> worst;
  for (const TreeLink& link : cut)
    for (const std::size_t s : {link.parent, link.child})
      if (!motion.segments[s].restarts.empty() && mean_piece(motion, s) < least_piece &&
          (!worst || mean_piece(motion, s) < mean_piece(motion, *worst)))
        worst = s;
  return worst;
}

Finding fragmented_finding(const RecordedMotion& motion, std::size_t fragmented,
                           const std::vector<std::size_t>& selected) {
  std::vector<std::size_t> left_out;
  for (std::size_t s = 0; s < motion.segments.size(); ++s)
    if (std::ranges::find(selected, s) == selected.end()) left_out.push_back(s);
  return {.kind = FindingKind::fragmented_sensor,
          .severity = Severity::warning,
          .values = {{"sensor", motion.segments[fragmented].name},
                     {"pieces", static_cast<int>(motion.segments[fragmented].restarts.size()) + 1},
                     {"piece", mean_piece(motion, fragmented)},
                     {"left_out", names_of(motion, left_out)}},
          .applied = true};
}

}  // namespace

RecordingSelection exclude_idle_sensors(const InsRecording& recording, const SegmentMotionOptions& options,
                                        const std::optional<std::string>& root) {
  RecordingSelection chosen;
  std::vector<std::string> still, left_out;
  const auto rests = rest_periods_of(recording);
  for (std::size_t s = 0; s < rests.size(); ++s)
    if (const InsSensor& sensor = recording.sensors[s];
        is_stationary(sensor, recording.time(sensor), options, rests[s]))
      still.push_back(sensor.name);
  const bool root_is_stationary = root && std::ranges::find(still, *root) != still.end();
  const std::string kept = still.empty() ? "" : root_is_stationary ? *root : still.front();
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) {
    const std::string& name = recording.sensors[s].name;
    const bool is_left_out = name != kept && std::ranges::find(still, name) != still.end();
    if (is_left_out)
      left_out.push_back(name);
    else
      chosen.sensors.push_back(s);
  }
  if (still.size() == recording.sensors.size()) return select_all(recording.sensors.size());  // nothing moved
  if (left_out.empty()) return chosen;
  chosen.findings.push_back({.kind = FindingKind::idle,
                             .severity = Severity::warning,
                             .values = {{"stationary", still}, {"left_out", left_out}, {"kept", kept}},
                             .applied = true});
  return chosen;
}

RecordingSelection select_machine(const OrderedMotion& ordered, const std::optional<std::string>& root,
                                  std::span<const PairConnection> connections) {
  const std::size_t segments = ordered.motion.segments.size();
  const std::vector<TreeLink> links = links_of(ordered);
  RecordingSelection chosen = select_all(segments);
  if (links.size() < min_tree_links) return chosen;
  const double median_misfit = usual_misfit(links);
  std::vector<TreeLink> kept, cut;
  for (const TreeLink& link : links) (is_no_joint(ordered.tree, link, median_misfit) ? cut : kept).push_back(link);
  if (cut.empty()) return chosen;
  const auto groups = groups_of(segments, kept);
  auto best = std::ranges::max_element(groups, {}, [](const auto& group) { return group.size(); });
  for (auto group = groups.begin(); root && group != groups.end(); ++group)
    for (const std::string& name : names_of(ordered.motion, *group))
      if (name == *root && group->size() > 1) best = group;
  chosen.sensors = *best;
  if (const auto fragmented = fragmented_segment(ordered.motion, cut)) {
    chosen.findings.push_back(fragmented_finding(ordered.motion, *fragmented, chosen.sensors));
    return chosen;
  }
  const auto is_in = [](const std::vector<std::size_t>& group, std::size_t s) {
    return std::ranges::find(group, s) != group.end();
  };
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    if (group == best) continue;
    const auto link = std::ranges::min_element(cut, {}, [&](const TreeLink& l) {
      return is_in(*group, l.parent) || is_in(*group, l.child) ? l.misfit : std::numeric_limits<double>::infinity();
    });
    chosen.findings.push_back(separation_finding(ordered, *link, *group, median_misfit));
    if (const auto gain = connection_gain(connections, *link); gain && group->size() > 1)
      chosen.findings.back().values.set("connection_gain", *gain);
  }
  return chosen;
}

std::vector<std::vector<std::size_t>> groups_on_ground(const OrderedMotion& ordered) {
  const SegmentTree& tree = ordered.tree;
  if (!ordered.motion.segments[tree.root].still) return {};
  std::vector<TreeLink> within;
  for (const TreeLink& link : links_of(ordered))
    if (link.parent != tree.root) within.push_back(link);
  auto groups = groups_of(ordered.motion.segments.size(), within);
  std::erase_if(groups, [&](const auto& group) { return group.size() == 1 && group.front() == tree.root; });
  return groups;
}

std::vector<Finding> groups_attached_to_world(const OrderedMotion& ordered) {
  std::vector<std::string> groups;
  for (const auto& group : groups_on_ground(ordered))
    groups.push_back(fmt::format("{}", fmt::join(names_of(ordered.motion, group), ", ")));
  if (groups.size() < 2) return {};
  return {{.kind = FindingKind::several_machines, .severity = Severity::warning, .values = {{"groups", groups}}}};
}

}  // namespace kinfer::identify
