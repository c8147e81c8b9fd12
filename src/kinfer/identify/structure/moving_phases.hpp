// SPDX-License-Identifier: Apache-2.0
// Paper 1's table 3: ranks the segments of a machine by when they move, if its joints are moved one after the other.
//
// A phase is a time segment in which the same set of sensors moves. A sensor on a distal segment moves in every phase
// in which a proximal one does, and in more. So the sum of a sensor's column is its rank, and in a tree its parent is
// the sensor that moves in the most of its phases and in no others. Fails if the base moves or the machine sways; it
// therefore serves as a cross-check only.
#pragma once

#include <string>
#include <vector>

#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

struct MovingPhase {
  double begin = 0.0, end = 0.0;  ///< [s] of its first appearance
  std::vector<bool> moves;        ///< of each segment
};

struct MovingPhases {
  std::vector<MovingPhase> phases;                 ///< table 3's rows: distinct sets of moving sensors, chronological
  std::vector<int> rank;                           ///< table 3's sums, one per segment
  std::vector<std::optional<std::size_t>> parent;  ///< of each segment; none if no sensor moves in fewer phases
  bool is_unambiguous = false;                     ///< exactly one segment has no parent, and no two have equal columns
};

MovingPhases moving_phases(const RecordedMotion& motion);

/// Whether the phases give every segment the same parent as the tree.
bool has_same_parents(const MovingPhases& phases, const SegmentTree& tree);

}  // namespace kinfer::identify
