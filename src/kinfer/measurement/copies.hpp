// SPDX-License-Identifier: Apache-2.0
// Measurements that are copies of others, to the last bit: they say nothing that the others have not said.
#pragma once

#include <vector>

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The set without the measurements that equal an earlier one of the same kind and fixture, at the same joint positions
/// and conditions. A row keeps its place and its joints. Of copies among fitted and held-out rows, a fitted one stays.
PoseSet without_copies(PoseSet set);

/// Groups of two or more rows that hold the same measurements, all of them copies of one another; each ascending.
std::vector<std::vector<int>> groups_of_copies(const PoseSet& set);

}  // namespace kinfer
