// SPDX-License-Identifier: Apache-2.0
// Which rows of a pose set repeat a commanded pose.
//
// Repeats are told by the structure of the joint positions alone, in no unit: rows that lie close together while
// nothing lies between them and all others. Of rows that scatter on one level (at random, on a path, on a grid), in a
// space of one dimension or more and however unevenly, those nearer than ρδ to a row lie within δ of it with a
// probability of 1/ρ at most. So of the clusters that have rows nearer than ρδ, the part whose rows all lie within δ
// is compared with 1/ρ, for every δ and ρ. Where the best of them has odds of repeat_odds and more against one level,
// rows within √ρ δ are one pose.
#pragma once

#include <vector>

#include "kinfer/linalg/types.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The commanded pose of each row, numbered in the order of their first rows. `joints`: one column a row; `scale`: the
/// unit in which the differences of each joint are compared, at least its range, 0 of a joint that does not move. A row
/// repeats the first pose from whose first row no joint differs by more than repeats do. A million rows take seconds.
std::vector<int> commanded_poses(const MatrixXd& joints, const VectorXd& scale);

/// As the set says, or else in units of each joint's range.
std::vector<int> commanded_poses(const PoseSet& data);

/// Of a row, as the set says. Where it does not, each row is a pose.
int pose_of_row(const PoseSet& data, int row);

/// How many different poses these rows are, all rows by default.
std::size_t distinct_poses(const PoseSet& data, const std::vector<int>& rows);
std::size_t distinct_poses(const PoseSet& data);

/// Largest difference within a pose, in units of `scale`: that of rounding where nothing is repeated with scatter.
double repeat_distance(const MatrixXd& joints, const VectorXd& scale);

}  // namespace kinfer
