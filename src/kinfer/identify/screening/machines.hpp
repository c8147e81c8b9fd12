// SPDX-License-Identifier: Apache-2.0
// Whether the sensors of a log belong to one machine, and which of them to use if not.
//
// Segments that share a joint agree on the acceleration of a point. If the residual of the best link between two groups
// of segments is many times that of the links within them, no joint connects the groups: two machines in one log, a
// linkage, or a segment without an INS between them.
#pragma once

#include <span>

#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/screening/recording_selection.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

/// All sensors except those that never move; one stationary sensor is kept as the root.
RecordingSelection exclude_idle_sensors(const InsRecording& recording, const SegmentMotionOptions& options,
                                        const std::optional<std::string>& root);

/// The largest connected group of segments, or the one of `root`. `connections` of the tree's links, where they are
/// known: of a group that moves with the others for all that, a finding says so (`connection_gain`).
RecordingSelection select_machine(const OrderedMotion& ordered, const std::optional<std::string>& root,
                                  std::span<const PairConnection> connections = {});

/// Groups of segments that share nothing but a stationary root, which is in none; none where the root moves.
std::vector<std::vector<std::size_t>> groups_on_ground(const OrderedMotion& ordered);

/// If the root is stationary and has several branches: a finding about them.
std::vector<Finding> groups_attached_to_world(const OrderedMotion& ordered);

}  // namespace kinfer::identify
