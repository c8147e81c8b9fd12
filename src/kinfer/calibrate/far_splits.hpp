// Splits that ask a model about joint angles far from those that it was fitted on.
#pragma once

#include <vector>

#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer {

/// Four splits: the rows are halved along the first and along the second principal direction of the joint readings
/// (each in units of its own spread), and each half is held out once. A random fold asks about poses between the fitted
/// ones, these about poses beyond them. None where fewer than `fewest` rows would be left to fit. Ball-bars that a
/// split would cut are left out by `select`.
std::vector<Split> far_splits(const PoseSet& data, int fewest = 15);

}  // namespace kinfer
