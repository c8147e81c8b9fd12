// SPDX-License-Identifier: Apache-2.0
// Sensors that have nothing to do with the others, or only in a part of the recording.
#pragma once

#include "kinfer/identify/screening/connection.hpp"
#include "kinfer/identify/screening/recording_selection.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

/// Whether no link of the tree is a connection: then there is no machine to separate anything from.
bool is_unconnected(const std::vector<PairConnection>& connections);

/// Whether there is a link that may be relied on.
bool has_certain_joint(const std::vector<PairConnection>& connections);

/// The largest group of connected segments, or the one of `root`; all if every link is a connection, or none.
/// Findings: the other segments, as mixed recordings where they are connected in a part of the recording only.
/// `connections`: of the links of the tree.
RecordingSelection select_connected(const OrderedMotion& ordered, const std::vector<PairConnection>& connections,
                                    const std::optional<std::string>& root, int threads);

}  // namespace kinfer::identify
