#include "kinfer/identify/loops.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace kinfer {
namespace {

constexpr double moving = 0.05;     // [rad/s] rms that shows a joint
constexpr double as_good = 3.0;     // times what the tree's own joints leave
constexpr double hinge_like = 0.1;  // of the relative rate off the axis

bool is_moving_hinge(const PairFit& pair) {
  return pair.relative_rate() > moving && pair.off_axis_rate() < hinge_like * pair.relative_rate();
}

bool closes_loop(const SegmentTree& tree, const PairFit& pair) {
  const auto path = path_between(tree, pair.first, pair.second);
  if (path.size() < 3 || !is_moving_hinge(pair)) return false;
  double residual = 0.0, off_axis = 0.0;
  for (const auto& [a, b] : path) {
    const PairFit& own = tree.pair(a, b);
    if (!is_moving_hinge(own)) return false;
    residual = std::max(residual, own.residual());
    off_axis = std::max(off_axis, own.off_axis_rate());
  }
  return pair.residual() < as_good * residual && pair.off_axis_rate() < as_good * off_axis;
}

}  // namespace

std::vector<PairFit> loop_closing_pairs(const SegmentTree& tree) {
  std::vector<PairFit> closing;
  std::ranges::copy_if(tree.pairs, std::back_inserter(closing), [&](const PairFit& pair) {
    return tree.parent[pair.first] != pair.second && tree.parent[pair.second] != pair.first && closes_loop(tree, pair);
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
    findings.push_back(
        {.kind = "loop",
         .severity = Severity::warning,
         .sentence = fmt::format("the segments {} close a loop: {} and {} share a hinge too ({:.3f} m/s² left, the "
                                 "others leave up to {:.3f}); the chain is cut open there",
                                 fmt::join(loop, ", "), names[pair.first], names[pair.second], pair.residual(), worst),
         .suggestion = "take the joint angles of a linkage as they are measured: they depend on each other"});
  }
  return findings;
}

}  // namespace kinfer
