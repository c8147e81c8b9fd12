// SPDX-License-Identifier: Apache-2.0
// Train/holdout splits: rows that are fitted, and rows that are held out to validate the fit.
#pragma once

#include <vector>

#include "kinfer/base/rng.hpp"

namespace kinfer {

struct Split {
  std::vector<int> train;    ///< ascending
  std::vector<int> holdout;  ///< ascending
};

/// A random `fraction` of the rows 0 .. count-1 is held out; at least one row on each side where count >= 2.
Split random_split(int count, double fraction, Rng rng);

/// k splits whose held-out parts are disjoint and cover all rows; sizes differ by one at most.
std::vector<Split> folds(int count, int k, Rng rng);

}  // namespace kinfer
