// SPDX-License-Identifier: Apache-2.0
// A pose set out of a robot's joint log and a tracker's file.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kinfer/measurement/pairing/pair_rests.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Rests of the joints (joint positions) or of the tool point (measured) in a file's rows: found by the time column
/// where the rows are a stream (more than two a second), else each row, or group of equal rows, is one. Times of a list
/// are those of its rows.
std::vector<Rest> joint_rests(const PoseSet& joints);
std::vector<Rest> measured_rests(const PoseSet& measured);

/// By `method`; none: by name where both files have names, by time where both have times, else by order.
Result<RestPairing> pair_rests(const RestLists& lists, std::optional<PairingMethod> method,
                               std::optional<double> offset);

/// One row a pair: means of the joint positions, of the tool point and of its orientation. The scatter of a point
/// becomes its standard deviation where each of its components has one. `id` and `line` are those of the first joint
/// row.
PoseSet paired_set(const PoseSet& joints, const PoseSet& measured, const RestLists& lists, const RestPairing& pairing);

}  // namespace kinfer
