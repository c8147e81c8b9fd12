// Who moves when: paper 1's table 3, which ranks the segments of a machine whose joints are moved one after the other.
//
// A phase is a stretch of time in which the same sensors move. A sensor on a farther segment moves in every phase in
// which a nearer one does, and in more. So the sum of a sensor's column is its rank, and in a tree its parent is the
// sensor that moves in the most of its phases and in no others. Fails where the base moves or the machine sways: a
// witness, no judge.
#pragma once

#include <string>
#include <vector>

#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

struct MovingPhase {
  double begin = 0.0, end = 0.0;  ///< [s] of its first appearance
  std::vector<bool> moves;        ///< of each segment
};

struct MovingPhases {
  std::vector<MovingPhase> phases;  ///< table 3's rows: distinct sets of moving sensors, in order of time
  std::vector<int> rank;            ///< table 3's sums, one a segment
  std::vector<std::optional<std::size_t>> parent;  ///< of each segment; nothing where no sensor moves in fewer phases
  bool told_apart = false;  ///< exactly one segment is without parent, and no two have equal columns
};

struct MovingPhaseOptions {
  double rate = 0.05;          ///< [rad/s] rms within the window that counts as motion
  double acceleration = 0.25;  ///< [m/s²] rms likewise, against that at rest: slides do not turn
  double window = 0.25;        ///< [s]
  double shortest = 1.0;       ///< [s] of a phase; shorter ones are the changes between phases
};

MovingPhases moving_phases(const RecordedMotion& motion, const MovingPhaseOptions& options = {});

/// Whether the table gives every segment the parent that the tree has.
bool agree(const MovingPhases& phases, const SegmentTree& tree);

}  // namespace kinfer
