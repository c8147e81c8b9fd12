// SPDX-License-Identifier: Apache-2.0
// Lists of rows of a pose set, and a thinned copy of it.
#pragma once

#include <vector>

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

std::vector<int> all_rows(const PoseSet& data);

/// The rows that are not among `others`.
std::vector<int> without(std::vector<int> rows, const std::vector<int>& others);

/// At most `most` of 0, 1, …, `count` − 1, evenly spread; ascending.
std::vector<int> spread_indices(int count, int most);

/// At most `most` of the rows with points, evenly spread; ascending.
std::vector<int> thinned_rows(const PoseSet& data, std::size_t most);

/// These rows, without orientations.
PoseSet thin_pose_set(const PoseSet& data, std::size_t most);

}  // namespace kinfer
