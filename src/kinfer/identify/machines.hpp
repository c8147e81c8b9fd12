// Whether the sensors of a log belong to one machine, and which to go on with where they do not.
//
// Segments that share a joint agree on the acceleration of a point; where the best link between two groups of segments
// leaves many times what the links within them leave, nothing joins them: two machines in one log, a linkage or a
// segment without an INS between.
#pragma once

#include "kinfer/evidence/findings.hpp"
#include "kinfer/identify/ordered_motion.hpp"

namespace kinfer {

struct Chosen {
  std::vector<std::size_t> sensors;  ///< that identification goes on with, by index
  std::vector<Finding> findings;     ///< about those that are left out
};

/// All sensors but those that never move: one of them, the root, may stand still.
Chosen without_idle(const InsRecording& recording, const SegmentMotionOptions& options,
                    const std::optional<std::string>& root);

/// The largest group of segments that hang together, or that of `root`.
Chosen one_machine(const OrderedMotion& ordered, const std::optional<std::string>& root);

/// Where everything else hangs on a segment that stands still: its branches, if there are several.
std::vector<Finding> groups_on_the_ground(const OrderedMotion& ordered);

}  // namespace kinfer
