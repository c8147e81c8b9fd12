// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/bacterial_search.hpp"

#include <cmath>

#include "kinfer/identify/programming/thresholds.hpp"

namespace kinfer::identify {
namespace {

bool is_near_gimbal_lock(const Mat3& ground_R_sensor) {
  return std::hypot(ground_R_sensor(2, 1), ground_R_sensor(2, 2)) < gimbal_lock_cosine;  // cos theta
}

}  // namespace

std::vector<std::size_t> informative_rows(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                          JointVariableKind terminals) {
  const SegmentMotion &p = motion.segments[parent], &c = motion.segments[child];
  std::vector<std::size_t> rows;
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); ++row) {
    if (!motion.usable[row] || c.angular_velocity[row].norm() < min_informative_rate) continue;
    if (terminals == JointVariableKind::euler &&
        (is_near_gimbal_lock(p.rotation[row]) || is_near_gimbal_lock(c.rotation[row])))
      continue;
    rows.push_back(row);
  }
  return rows;
}

OrientationMetric orientation_metric(JointVariableKind terminals) {
  return terminals == JointVariableKind::euler ? OrientationMetric::euler : OrientationMetric::chord;
}

LinkEvolution search_bacterial(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                               std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                               const BacterialProgramming& options, const Rng& rng, const Observer& observer) {
  const auto chosen = thin_rows(rows, static_cast<std::size_t>(options.rows));
  const LinkCost cost(parent, child, signals, chosen, {.orientation = orientation_metric(options.terminals)});
  const DhLeafOptions leaf{.signals = static_cast<int>(signals.size()),
                           .signal_angle_form = options.terminals == JointVariableKind::euler
                                                    ? SignalAngleForm::plain
                                                    : SignalAngleForm::offset};
  return evolve_bacteria(DhBreed(DhLeafOperators(leaf), options.depth),
                         GenomeCost<DhTree>([&](const DhTree& tree, double bound) { return cost(tree, bound); }),
                         options.bacteria, rng, observer);
}

}  // namespace kinfer::identify
