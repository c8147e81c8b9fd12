// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/loops.hpp"

#include <algorithm>
#include <set>

#include "kinfer/identify/screening/thresholds.hpp"

namespace kinfer::identify {
namespace {

bool is_moving_revolute(const PairFit& pair) {
  return pair.relative_rate() > min_loop_joint_rate &&
         pair.off_axis_rate() < max_revolute_off_axis_share * pair.relative_rate();
}

bool closes_loop(const SegmentTree& tree, const PairFit& pair) {
  const auto path = path_between(tree, pair.first, pair.second);
  if (path.size() < 3 || !is_moving_revolute(pair)) return false;
  double residual = 0.0, off_axis = 0.0;
  for (const auto& [a, b] : path) {
    const PairFit& own = tree.pair(a, b);
    if (!is_moving_revolute(own)) return false;
    residual = std::max(residual, own.residual());
    off_axis = std::max(off_axis, own.off_axis_rate());
  }
  return pair.residual() < max_loop_residual_ratio * residual &&
         pair.off_axis_rate() < max_loop_residual_ratio * off_axis;
}

}  // namespace

std::vector<PairFit> loop_closing_pairs(const SegmentTree& tree) {
  std::vector<PairFit> closing;
  std::ranges::copy_if(tree.pairs, std::back_inserter(closing), [&](const PairFit& pair) {
    return !is_edge(tree, pair.first, pair.second) && closes_loop(tree, pair);
  });
  return closing;
}

std::vector<Finding> loop_findings(const SegmentTree& tree, const std::vector<PairFit>& closing,
                                   const std::vector<std::string>& names) {
  std::vector<Finding> findings;
  for (const PairFit& pair : closing) {
    std::set<std::size_t> segments;
    double worst = 0.0;
    for (const auto& [a, b] : path_between(tree, pair.first, pair.second)) {
      segments.insert({a, b});
      worst = std::max(worst, tree.pair(a, b).residual());
    }
    std::vector<std::string> loop;
    for (const std::size_t s : segments) loop.push_back(names[s]);
    findings.push_back({.kind = FindingKind::loop,
                        .severity = Severity::warning,
                        .values = {{"segments", loop},
                                   {"first", names[pair.first]},
                                   {"second", names[pair.second]},
                                   {"residual", pair.residual()},
                                   {"largest_tree_residual", worst}}});
  }
  return findings;
}

}  // namespace kinfer::identify
