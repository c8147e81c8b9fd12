// SPDX-License-Identifier: Apache-2.0
// Splits that test a model's extrapolation to joint positions far from the fitted ones.
#pragma once

#include <cstddef>
#include <vector>

#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

/// Four splits: along the first and along the second principal direction of the joint positions (each standardised),
/// the quarter of the rows at each end is held out once. Random folds test interpolation between the fitted poses,
/// these splits test extrapolation beyond them. None where fewer than `fewest` rows would be left to fit. `select`
/// drops ball-bar measurements whose two rows fall on different sides of a split.
std::vector<Split> extrapolation_splits(const PoseSet& data, int fewest = thresholds::min_extrapolation_rows);

/// Every nth row on both sides of each split, so that at most `most` are left to fit.
std::vector<Split> thinned(std::vector<Split> splits, std::size_t most);

}  // namespace kinfer::calibrate
