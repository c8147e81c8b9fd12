#include "kinfer/identify/segment_order.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Edge = std::pair<std::size_t, std::size_t>;
constexpr std::size_t fitted_rows = 3000;  // more do not change the order
constexpr double least_turning = 0.02;     // [rad/s] below it the direction of a relative rate is noise

/// K of the header in the ground, times ground_R_sensor: acts on lever arms in the sensor.
Mat3 lever_effect(const SegmentMotion& m, std::size_t row) {
  const Mat3 rate = skew(m.rate[row]);
  return (skew(m.rate_change[row]) + rate * rate) * m.rotation[row];
}

std::vector<std::size_t> moving_rows(const RecordedMotion& motion) {
  std::vector<std::size_t> rows;
  const std::size_t stride = std::max<std::size_t>(1, (motion.rows() - motion.first_motion) / fitted_rows);
  for (std::size_t row = motion.first_motion; row < motion.rows(); row += stride)
    if (motion.usable[row]) rows.push_back(row);
  return rows;
}

/// The point with the shortest lever arms among those that fit equally well.
void fit_common_point(PairFit& fit, const SegmentMotion& a, const SegmentMotion& b,
                      const std::vector<std::size_t>& rows) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  constexpr double shortness = 1e-4;  // [1/s²] squared: prior on lever arms of what no acceleration tells
  Matrix6 normal = static_cast<double>(rows.size()) * shortness * Matrix6::Identity();
  Vector6 right = Vector6::Zero();
  double square = 0.0;
  for (const std::size_t row : rows) {
    Eigen::Matrix<double, 3, 6> k;
    k << lever_effect(a, row), -lever_effect(b, row);
    const Vec3 difference = b.acceleration[row] - a.acceleration[row];
    normal += k.transpose() * k;
    right += k.transpose() * difference;
    square += difference.squaredNorm();
  }
  const VectorXd arms = solve_least_squares(normal, right, 1e-10);
  const double left = square - 2.0 * arms.dot(right) + arms.dot(normal * arms);
  fit.residual = std::sqrt(std::max(0.0, left) / static_cast<double>(rows.size()));
  fit.point_in_first = arms.head<3>();
  fit.point_in_second = arms.tail<3>();
}

void fit_common_axis(PairFit& fit, const SegmentMotion& a, const SegmentMotion& b,
                     const std::vector<std::size_t>& rows) {
  Mat3 spread = Mat3::Zero();
  for (const std::size_t row : rows) {
    const Vec3 relative = a.rotation[row].transpose() * (b.rate[row] - a.rate[row]);
    spread += relative * relative.transpose() / static_cast<double>(rows.size());
  }
  const VectorXd squares = symmetric_eigen(spread).values;
  fit.off_axis_rate = std::sqrt(std::max(0.0, squares[0] + squares[1]));
  fit.relative_rate = std::sqrt(std::max(0.0, squares.sum()));
}

/// Takes the difference along its principal direction in the first sensor out of the residual.
void fit_slide(PairFit& fit, const SegmentMotion& a, const SegmentMotion& b, const std::vector<std::size_t>& rows) {
  Mat3 spread = Mat3::Zero();
  for (const std::size_t row : rows) {
    const Vec3 difference = b.acceleration[row] + lever_effect(b, row) * fit.point_in_second - a.acceleration[row] -
                            lever_effect(a, row) * fit.point_in_first;
    const Vec3 in_first = a.rotation[row].transpose() * difference;
    spread += in_first * in_first.transpose() / static_cast<double>(rows.size());
  }
  const VectorXd squares = symmetric_eigen(spread).values;
  fit.slide = std::sqrt(std::max(0.0, squares[2]));
  fit.residual = std::sqrt(std::max(0.0, squares[0] + squares[1]));
}

PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows) {
  PairFit fit{.first = first, .second = second};
  fit_common_point(fit, motion.segments[first], motion.segments[second], rows);
  fit_common_axis(fit, motion.segments[first], motion.segments[second], rows);
  if (fit.relative_rate < least_turning) fit_slide(fit, motion.segments[first], motion.segments[second], rows);
  fit.weight =
      fit.residual * (1.0 + off_axis_weight * fit.off_axis_rate / std::hypot(fit.relative_rate, least_turning));
  return fit;
}

/// Kruskal 1956.
std::vector<Edge> minimum_spanning_tree(std::vector<PairFit> pairs, std::size_t segments) {
  std::ranges::stable_sort(pairs, {}, &PairFit::weight);
  std::vector<std::size_t> component(segments);
  std::iota(component.begin(), component.end(), std::size_t{0});
  std::vector<Edge> edges;
  for (const PairFit& pair : pairs) {
    const std::size_t from = component[pair.second], to = component[pair.first];
    if (from == to) continue;
    edges.emplace_back(pair.first, pair.second);
    std::ranges::replace(component, from, to);
  }
  return edges;
}

double turning(const SegmentMotion& segment) {
  double sum = 0.0;
  for (const Vec3& rate : segment.gyro) sum += rate.squaredNorm();
  return std::sqrt(sum / static_cast<double>(segment.gyro.size()));
}

Result<std::size_t> choose_root(const RecordedMotion& motion, const std::vector<Edge>& edges,
                                const std::optional<std::string>& name) {
  std::vector<std::string> names, still;
  for (const SegmentMotion& segment : motion.segments) {
    names.push_back(segment.name);
    if (segment.still) still.push_back(segment.name);
  }
  if (still.size() > 1)
    return error("sensors {} never move: at most one, the root, may stand still; move every joint",
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
    if (degree[i] == 1 && (best == names.size() || turning(motion.segments[i]) < turning(motion.segments[best])))
      best = i;
  return best;
}

/// Largest weight on the way from a to b within the tree.
double largest_weight_between(const SegmentTree& tree, std::size_t a, std::size_t b) {
  const auto path_to_root = [&](std::size_t node) {
    std::vector<std::size_t> path{node};
    while (tree.parent[path.back()]) path.push_back(*tree.parent[path.back()]);
    return path;
  };
  std::vector<std::size_t> up = path_to_root(a), down = path_to_root(b);
  while (up.size() > 1 && down.size() > 1 && up[up.size() - 2] == down[down.size() - 2]) up.pop_back(), down.pop_back();
  double largest = 0.0;
  for (const auto* path : {&up, &down})
    for (std::size_t i = 0; i + 1 < path->size(); ++i)
      largest = std::max(largest, tree.pair((*path)[i], (*path)[i + 1]).weight);
  return largest;
}

double margin_of(const SegmentTree& tree) {
  double margin = std::numeric_limits<double>::infinity();
  for (const PairFit& pair : tree.pairs)
    if (tree.parent[pair.first] != pair.second && tree.parent[pair.second] != pair.first)
      margin = std::min(margin, pair.weight / largest_weight_between(tree, pair.first, pair.second));
  return margin;
}

}  // namespace

const PairFit& SegmentTree::pair(std::size_t a, std::size_t b) const {
  const auto found = std::ranges::find_if(
      pairs, [&](const PairFit& p) { return p.first == std::min(a, b) && p.second == std::max(a, b); });
  KINFER_EXPECT(found != pairs.end(), "no pair {}, {}", a, b);
  return *found;
}

void hang_up(SegmentTree& tree, const std::vector<Edge>& edges) {
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

Result<SegmentTree> segment_tree(const RecordedMotion& motion, const std::optional<std::string>& root) {
  const std::vector<std::size_t> rows = moving_rows(motion);
  if (rows.size() < 50)
    return error("only {} rows in which the machine moves and every sensor has sound readings", rows.size());
  SegmentTree tree;
  for (std::size_t first = 0; first < motion.segments.size(); ++first)
    for (std::size_t second = first + 1; second < motion.segments.size(); ++second)
      tree.pairs.push_back(fit_pair(motion, first, second, rows));
  const std::vector<Edge> edges = minimum_spanning_tree(tree.pairs, motion.segments.size());
  KINFER_TRY(chosen, choose_root(motion, edges, root));
  tree.root = chosen;
  hang_up(tree, edges);
  tree.margin = margin_of(tree);
  return tree;
}

}  // namespace kinfer
