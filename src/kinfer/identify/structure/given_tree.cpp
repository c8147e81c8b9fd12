// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/given_tree.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/identify/structure/thresholds.hpp"

namespace kinfer::identify {
namespace {

Result<std::size_t> sensor_named(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return error("--tree {}: no such sensor; the log has {}", name, fmt::join(names, ", "));
  return static_cast<std::size_t>(found - names.begin());
}

/// Worst link on the found tree's path between two segments: the one that the given link replaces.
const PairFit& replaced_pair(const SegmentTree& found, std::size_t a, std::size_t b) {
  const PairFit* worst = nullptr;
  for (const auto& [near, far] : path_between(found, a, b))
    if (const PairFit& pair = found.pair(near, far); !worst || pair.distance > worst->distance) worst = &pair;
  return *worst;
}

/// [m/s²], [rad/s], and the ratio of the motion that the two pairs leave unexplained a row.
Finding finding_about(const PairFit& given, const PairFit& replaced, const std::vector<std::string>& names) {
  const double gap = given.distance - replaced.distance;
  return {.kind = FindingKind::given_link,
          .severity = gap < decisive_link_gap ? Severity::note : Severity::fault,
          .values = {{"link", names[given.first] + "-" + names[given.second]},
                     {"replaced_link", names[replaced.first] + "-" + names[replaced.second]},
                     {"residual", given.residual()},
                     {"off_axis_rate", given.off_axis_rate()},
                     {"replaced_residual", replaced.residual()},
                     {"replaced_off_axis_rate", replaced.off_axis_rate()},
                     {"ratio", std::exp(gap)}}};
}

}  // namespace

Result<SegmentTree> given_tree(const SegmentTree& found, const std::vector<std::string>& names,
                               const std::vector<GivenLink>& links) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (const GivenLink& link : links) {
    KINFER_TRY(first, sensor_named(names, link.first));
    KINFER_TRY(second, sensor_named(names, link.second));
    if (first == second) return error("--tree {}-{}: a link needs two sensors", link.first, link.second);
    edges.emplace_back(first, second);
  }
  if (edges.size() + 1 != names.size())
    return error("--tree: {} links given; {} sensors need {}", edges.size(), names.size(), names.size() - 1);
  SegmentTree tree = found;
  orient_tree(tree, edges);
  if (tree.order.size() != names.size())
    return error("--tree: the links form a loop and do not connect all of {}", fmt::join(names, ", "));
  return tree;
}

std::vector<Finding> findings_about(const SegmentTree& given, const SegmentTree& found,
                                    const std::vector<std::string>& names) {
  std::vector<Finding> findings;
  for (const PairFit& pair : given.pairs)
    if (is_edge(given, pair.first, pair.second) && !is_edge(found, pair.first, pair.second))
      findings.push_back(finding_about(pair, replaced_pair(found, pair.first, pair.second), names));
  return findings;
}

}  // namespace kinfer::identify
