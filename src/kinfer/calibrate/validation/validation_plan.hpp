// SPDX-License-Identifier: Apache-2.0
// Which rows are fitted for the result, and which splits validate it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer::calibrate {

struct ValidationPlan {
  std::vector<int> fitted;
  std::vector<Split> proofs;
  std::string words;          ///< "5-fold cross-validation"
  bool fits_all_rows = true;  ///< false: the result is fitted on the train rows of the only split
};

/// Rows linked by a ball-bar stay on one side of a split. An error if too few rows are left to fit or to validate.
Result<ValidationPlan> make_validation_plan(const PoseSet& data, const HoldoutChoice& choice, Rng rng);

/// k splits of all rows of `data`, with linked rows together.
std::vector<Split> make_row_folds(const PoseSet& data, int k, Rng rng);

std::vector<int> all_rows(const PoseSet& data);

/// The rows without the listed ones, or without the outliers of a fit.
std::vector<int> without(std::vector<int> rows, const std::vector<int>& others);
std::vector<int> without(std::vector<int> rows, const std::vector<Outlier>& outliers);

}  // namespace kinfer::calibrate
