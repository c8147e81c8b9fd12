// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/segment_tree.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/identify/structure/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Edge = std::pair<std::size_t, std::size_t>;

/// Kruskal's algorithm (1956).
std::vector<PairFit> minimum_spanning_pairs(std::vector<PairFit> pairs, std::size_t segments) {
  std::ranges::stable_sort(pairs, {}, &PairFit::distance);
  std::vector<std::size_t> component(segments);
  std::iota(component.begin(), component.end(), std::size_t{0});
  std::vector<PairFit> tree;
  for (const PairFit& pair : pairs) {
    const std::size_t from = component[pair.second], to = component[pair.first];
    if (from == to) continue;
    tree.push_back(pair);
    std::ranges::replace(component, from, to);
  }
  return tree;
}

std::vector<Edge> minimum_spanning_tree(const std::vector<PairFit>& pairs, std::size_t segments) {
  std::vector<Edge> edges;
  for (const PairFit& pair : minimum_spanning_pairs(pairs, segments)) edges.emplace_back(pair.first, pair.second);
  return edges;
}

double rms_gyro(const SegmentMotion& segment) {
  double sum = 0.0;
  for (const Vec3& angular_velocity : segment.gyro) sum += angular_velocity.squaredNorm();
  return std::sqrt(sum / static_cast<double>(segment.gyro.size()));
}

Result<std::size_t> choose_root(const RecordedMotion& motion, const std::vector<Edge>& edges,
                                const std::optional<std::string>& name) {
  const std::vector<std::string> names = segment_names(motion);
  std::vector<std::string> still;
  for (const SegmentMotion& segment : motion.segments)
    if (segment.still) still.push_back(segment.name);
  if (still.size() > 1)
    return error(
        "sensors {} never move: at most one, the root, may be stationary; move every joint, and give each machine a "
        "log of its own",
        fmt::join(still, ", "));
  const auto index = [&](const std::string& wanted) {
    return static_cast<std::size_t>(std::ranges::find(names, wanted) - names.begin());
  };
  if (name && index(*name) == names.size())
    return error("--root {}: no such sensor; the log has {}", *name, fmt::join(names, ", "));
  if (name) return index(*name);
  if (!still.empty()) return index(still.front());
  std::vector<int> degree(names.size(), 0);
  for (const auto& [a, b] : edges) ++degree[a], ++degree[b];
  std::size_t best = names.size();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (degree[i] == 1 && (best == names.size() || rms_gyro(motion.segments[i]) < rms_gyro(motion.segments[best])))
      best = i;
  return best;
}

std::vector<PairFit> all_pairs(const RecordedMotion& motion, const std::vector<std::size_t>& rows,
                               HeadingReference headings, int threads) {
  std::vector<PairFit> pairs;
  for (std::size_t first = 0; first < motion.segments.size(); ++first)
    for (std::size_t second = first + 1; second < motion.segments.size(); ++second)
      pairs.push_back({.first = first, .second = second});
  parallel_for(pairs.size(), threads,
               [&](std::size_t i) { pairs[i] = fit_pair(motion, pairs[i].first, pairs[i].second, rows, headings); });
  return pairs;
}

}  // namespace

std::vector<std::size_t> moving_rows(const RecordedMotion& motion) {
  std::vector<std::size_t> rows;
  const std::size_t stride = std::max<std::size_t>(1, (motion.rows() - motion.first_motion_row) / tree_rows);
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); row += stride)
    if (motion.usable[row]) rows.push_back(row);
  return rows;
}

double spanning_length(const std::vector<PairFit>& pairs, std::size_t segments) {
  double length = 0.0;
  for (const PairFit& pair : minimum_spanning_pairs(pairs, segments)) length += pair.distance;
  return length;
}

const PairFit& SegmentTree::pair(std::size_t a, std::size_t b) const {
  const auto found = std::ranges::find_if(
      pairs, [&](const PairFit& p) { return p.first == std::min(a, b) && p.second == std::max(a, b); });
  KINFER_EXPECT(found != pairs.end(), "no pair {}, {}", a, b);
  return *found;
}

bool is_edge(const SegmentTree& tree, std::size_t a, std::size_t b) {
  return tree.parent[a] == b || tree.parent[b] == a;
}

std::vector<Edge> path_between(const SegmentTree& tree, std::size_t a, std::size_t b) {
  const auto path_to_root = [&](std::size_t node) {
    std::vector<std::size_t> path{node};
    while (tree.parent[path.back()]) path.push_back(*tree.parent[path.back()]);
    return path;
  };
  std::vector<std::size_t> path_from_a = path_to_root(a), path_from_b = path_to_root(b);
  while (path_from_a.size() > 1 && path_from_b.size() > 1 &&
         path_from_a[path_from_a.size() - 2] == path_from_b[path_from_b.size() - 2])
    path_from_a.pop_back(), path_from_b.pop_back();
  std::vector<Edge> edges;
  for (const auto* path : {&path_from_a, &path_from_b})
    for (std::size_t i = 0; i + 1 < path->size(); ++i) edges.emplace_back((*path)[i], (*path)[i + 1]);
  return edges;
}

double margin_of(const SegmentTree& tree, const std::vector<PairFit>& closes_loop) {
  double margin = std::numeric_limits<double>::infinity();
  for (const PairFit& pair : tree.pairs) {
    if (is_edge(tree, pair.first, pair.second)) continue;
    if (std::ranges::any_of(closes_loop,
                            [&](const PairFit& c) { return c.first == pair.first && c.second == pair.second; }))
      continue;
    for (const auto& [a, b] : path_between(tree, pair.first, pair.second))
      margin = std::min(margin, pair.distance - tree.pair(a, b).distance);
  }
  return std::exp(margin);
}

void orient_tree(SegmentTree& tree, const std::vector<Edge>& edges) {
  tree.order = {tree.root};
  tree.parent.assign(edges.size() + 1, std::nullopt);
  for (std::size_t next = 0; next < tree.order.size(); ++next)
    for (const auto& [a, b] : edges)
      for (const auto& [near, far] : {Edge{a, b}, Edge{b, a}})
        if (near == tree.order[next] && far != tree.root && !tree.parent[far]) {
          tree.parent[far] = near;
          tree.order.push_back(far);
        }
}

Result<SegmentTree> segment_tree(const RecordedMotion& motion, const std::optional<std::string>& root,
                                 HeadingReference headings, int threads) {
  if (std::ranges::all_of(motion.segments, &SegmentMotion::still))
    return error("nothing moved: all {} sensors stand still during the whole recording; move every joint",
                 motion.segments.size());
  const std::vector<std::size_t> rows = moving_rows(motion);
  if (rows.size() < least_tree_rows)
    return error("only {} rows in which the machine moves and all sensors have valid measurements", rows.size());
  SegmentTree tree;
  tree.pairs = all_pairs(motion, rows, headings, threads);
  const std::vector<Edge> edges = minimum_spanning_tree(tree.pairs, motion.segments.size());
  KINFER_TRY(chosen, choose_root(motion, edges, root));
  tree.root = chosen;
  orient_tree(tree, edges);
  tree.margin = margin_of(tree);
  return tree;
}

}  // namespace kinfer::identify
