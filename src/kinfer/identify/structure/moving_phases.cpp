// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/moving_phases.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/identify/structure/thresholds.hpp"

namespace kinfer::identify {
namespace {

Vec3 acceleration_at_rest(const RecordedMotion& motion, const SegmentMotion& segment) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t row = 0; row < motion.first_motion_row; ++row) sum += segment.acceleration[row];
  return sum / std::max(1.0, static_cast<double>(motion.first_motion_row));
}

/// For each window of rows: which segments rotate, or accelerate without rotation, as on a prismatic joint.
std::vector<std::vector<bool>> motion_by_window(const RecordedMotion& motion, std::size_t rows) {
  std::vector<std::vector<bool>> windows((motion.rows() - motion.rows() % rows) / rows);
  for (const SegmentMotion& segment : motion.segments) {
    const Vec3 rest = acceleration_at_rest(motion, segment);
    for (std::size_t window = 0; window < windows.size(); ++window) {
      double angular_velocity = 0.0, acceleration = 0.0;
      for (std::size_t row = window * rows; row < (window + 1) * rows; ++row) {
        angular_velocity += segment.angular_velocity[row].squaredNorm() / static_cast<double>(rows);
        acceleration += (segment.acceleration[row] - rest).squaredNorm() / static_cast<double>(rows);
      }
      windows[window].push_back(std::sqrt(angular_velocity) > moving_rate ||
                                std::sqrt(acceleration) > moving_acceleration);
    }
  }
  return windows;
}

/// Whether a moves in some phase in which b does not.
bool moves_without(const MovingPhases& table, std::size_t a, std::size_t b) {
  return std::ranges::any_of(table.phases, [&](const MovingPhase& phase) { return phase.moves[a] && !phase.moves[b]; });
}

/// The segment that moves in the most of this one's phases, but not in all of them, and in no others.
std::optional<std::size_t> parent_by_phases(const MovingPhases& table, std::size_t segment) {
  std::optional<std::size_t> parent;
  for (std::size_t other = 0; other < table.rank.size(); ++other)
    if (table.rank[other] < table.rank[segment] && !moves_without(table, other, segment) &&
        (!parent || table.rank[other] > table.rank[*parent]))
      parent = other;
  return parent;
}

bool columns_differ(const MovingPhases& table) {
  for (std::size_t a = 0; a < table.rank.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!moves_without(table, a, b) && !moves_without(table, b, a)) return false;
  return true;
}

}  // namespace

MovingPhases moving_phases(const RecordedMotion& motion) {
  MovingPhases table;
  const auto rows = std::max<std::size_t>(1, static_cast<std::size_t>(phase_window / motion.period));
  const double window = static_cast<double>(rows) * motion.period;
  const auto windows = motion_by_window(motion, rows);
  for (std::size_t begin = 0, end = 0; begin < windows.size(); begin = end) {
    while (end < windows.size() && windows[end] == windows[begin]) ++end;
    const bool is_long = static_cast<double>(end - begin) * window >= min_phase_duration;
    const bool is_rest = std::ranges::none_of(windows[begin], [](bool moves) { return moves; });
    const auto is_same = [&](const MovingPhase& phase) { return phase.moves == windows[begin]; };
    if (is_long && !is_rest && std::ranges::none_of(table.phases, is_same))
      table.phases.push_back({motion.time[begin * rows], motion.time[end * rows - 1], windows[begin]});
  }
  table.rank.assign(motion.segments.size(), 0);
  for (const MovingPhase& phase : table.phases)
    for (std::size_t i = 0; i < table.rank.size(); ++i) table.rank[i] += phase.moves[i] ? 1 : 0;
  for (std::size_t i = 0; i < table.rank.size(); ++i) table.parent.push_back(parent_by_phases(table, i));
  table.is_unambiguous =
      columns_differ(table) && std::ranges::count_if(table.parent, [](const auto& parent) { return !parent; }) == 1;
  return table;
}

bool has_same_parents(const MovingPhases& phases, const SegmentTree& tree) {
  return phases.is_unambiguous && phases.parent == tree.parent;
}

}  // namespace kinfer::identify
