// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_cost.hpp"

#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/identify/programming/link_block.hpp"

namespace kinfer::identify {
namespace {

double orientation_square(const LinkBlock& block, const FrameLanes& state, OrientationMetric error) {
  return error == OrientationMetric::euler ? block.squared_euler_error(state) : block.squared_chord(state);
}

}  // namespace

LinkCost::~LinkCost() = default;
LinkCost::LinkCost(LinkCost&&) noexcept = default;

LinkCost::LinkCost(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                   std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                   const LinkCostOptions& options)
    : blocks_(make_link_blocks(parent, child, signals, rows)), rows_(rows.size()), options_(options) {}

double LinkCost::operator()(const DhTree& tree, double bound) const {
  const std::vector<DhLeaf> factors = leaves(tree);
  double lengths = 0.0;
  for (const DhLeaf& leaf : factors) lengths += leaf.d * leaf.d + leaf.a * leaf.a;
  const int uses = count_signal_uses(factors);
  if (uses == 0) return std::numeric_limits<double>::infinity();  // a moving joint cannot be constant
  const double penalty =
      1.0 + options_.leaf_penalty * static_cast<double>(factors.size() - 1) + options_.signal_penalty * (uses - 1);
  const auto n = static_cast<double>(rows_);
  double sum = n * options_.length_prior * options_.length_prior * lengths;
  const double limit =
      bound < std::numeric_limits<double>::infinity() ? n * (bound / penalty) * (bound / penalty) : bound;
  for (const LinkBlock& block : blocks_) {
    const FrameLanes state = block.propagate(factors);
    sum += block.squared_acceleration_error(state);
    if (!(sum < limit)) return std::numeric_limits<double>::infinity();
    sum += orientation_square(block, state, options_.orientation);
    if (!(sum < limit)) return std::numeric_limits<double>::infinity();
  }
  return penalty * std::sqrt(sum / n);
}

JRmse LinkCost::j_rmse(std::span<const DhLeaf> leaves) const {
  double acceleration = 0.0, orientation = 0.0;
  for (const LinkBlock& block : blocks_) {
    const FrameLanes state = block.propagate(leaves);
    acceleration += block.squared_acceleration_error(state);
    orientation += orientation_square(block, state, options_.orientation);
  }
  const auto n = static_cast<double>(rows_);
  return {std::sqrt((acceleration + orientation) / n), std::sqrt(acceleration / n), std::sqrt(orientation / n)};
}

JRmse j_rmse(const std::vector<FrameState>& predicted, const std::vector<FrameState>& measured,
             const std::vector<std::size_t>& rows, OrientationMetric orientation) {
  double acceleration = 0.0, angles = 0.0;
  for (const std::size_t row : rows) {
    acceleration += (measured[row].acceleration - predicted[row].acceleration).squaredNorm();
    if (orientation == OrientationMetric::chord)
      angles += 0.5 * (measured[row].rotation - predicted[row].rotation).squaredNorm();
    else
      angles += Vec3(euler_angles(measured[row].rotation) - euler_angles(predicted[row].rotation))
                    .unaryExpr([](double x) { return wrap_to_pi(x); })
                    .squaredNorm();
  }
  const double n = std::max(1.0, static_cast<double>(rows.size()));
  return {std::sqrt((acceleration + angles) / n), std::sqrt(acceleration / n), std::sqrt(angles / n)};
}

std::vector<std::size_t> thin_rows(const std::vector<std::size_t>& rows, std::size_t count) {
  if (rows.size() <= count) return rows;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(rows[(2 * i + 1) * rows.size() / (2 * count)]);
  return chosen;
}

}  // namespace kinfer::identify
