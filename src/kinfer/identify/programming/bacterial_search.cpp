// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/bacterial_search.hpp"

#include <cmath>

namespace kinfer::identify {
namespace {

constexpr double min_angular_velocity = 0.02;  // [rad/s]
constexpr double gimbal_lock_cosine = 0.1;     // of the pitch, 6° from gimbal lock

bool is_near_gimbal_lock(const Mat3& ground_R_sensor) {
  return std::hypot(ground_R_sensor(2, 1), ground_R_sensor(2, 2)) < gimbal_lock_cosine;  // cos theta
}

}  // namespace

std::vector<std::size_t> informative_rows(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                          JointVariableKind terminals) {
  const SegmentMotion &p = motion.segments[parent], &c = motion.segments[child];
  std::vector<std::size_t> rows;
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); ++row) {
    if (!motion.usable[row] || c.angular_velocity[row].norm() < min_angular_velocity) continue;
    if (terminals == JointVariableKind::euler &&
        (is_near_gimbal_lock(p.rotation[row]) || is_near_gimbal_lock(c.rotation[row])))
      continue;
    rows.push_back(row);
  }
  return rows;
}

LinkEvolution search_bacterial(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                               std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                               const BacterialLinkOptions& options, const Rng& rng, const Observer& observer) {
  const auto chosen = thin_rows(rows, static_cast<std::size_t>(options.rows));
  const LinkCost cost(parent, child, signals, chosen, options.cost);
  DhLeafOptions leaf = options.leaf;
  leaf.signals = static_cast<int>(signals.size());
  return evolve_bacteria(DhBreed(DhLeafOperators(leaf), options.depth),
                         GenomeCost<DhTree>([&](const DhTree& tree, double bound) { return cost(tree, bound); }),
                         options.bacteria, rng, observer);
}

}  // namespace kinfer::identify
