#include "kinfer/identify/given_tree.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

Result<std::size_t> sensor_named(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return error("--tree {}: no such sensor; the log has {}", name, fmt::join(names, ", "));
  return static_cast<std::size_t>(found - names.begin());
}

bool joined(const SegmentTree& tree, std::size_t a, std::size_t b) {
  return tree.parent[a] == b || tree.parent[b] == a;
}

/// The found tree's worst link on the way between two segments: what the given link replaces.
const PairFit& replaced(const SegmentTree& found, std::size_t a, std::size_t b) {
  const PairFit* worst = nullptr;
  for (const auto& [near, far] : path_between(found, a, b))
    if (const PairFit& pair = found.pair(near, far); !worst || pair.distance > worst->distance) worst = &pair;
  return *worst;
}

Finding about(const PairFit& given, const PairFit& instead, const std::vector<std::string>& names) {
  constexpr double decisive = 0.7;  // [nats a row] twice as much unexplained
  const double gap = given.distance - instead.distance;
  const std::string link = names[given.first] + "-" + names[given.second],
                    other = names[instead.first] + "-" + names[instead.second];
  if (gap < decisive)
    return {.kind = "given_link",
            .severity = Severity::note,
            .sentence = fmt::format("the given link {} fits about as well as {}, which the log alone would choose",
                                    link, other)};
  return {.kind = "given_link",
          .severity = Severity::fault,
          .sentence = fmt::format("the given link {} is against the log: a joint there leaves {:.3f} m/s² and {:.4f} "
                                  "rad/s unexplained, {} leaves {:.3f} m/s² and {:.4f} rad/s ({:.2g} times less a row)",
                                  link, given.residual(), given.off_axis_rate(), other, instead.residual(),
                                  instead.off_axis_rate(), std::exp(gap)),
          .suggestion = "leave out --tree, or check which sensor sits on which segment"};
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
  hang_up(tree, edges);
  if (tree.order.size() != names.size())
    return error("--tree: the links close a ring and leave some of {} out", fmt::join(names, ", "));
  return tree;
}

std::vector<Finding> findings_about(const SegmentTree& given, const SegmentTree& found,
                                    const std::vector<std::string>& names) {
  std::vector<Finding> findings;
  for (const PairFit& pair : given.pairs)
    if (joined(given, pair.first, pair.second) && !joined(found, pair.first, pair.second))
      findings.push_back(about(pair, replaced(found, pair.first, pair.second), names));
  return findings;
}

}  // namespace kinfer
