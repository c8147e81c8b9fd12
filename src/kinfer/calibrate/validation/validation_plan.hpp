// SPDX-License-Identifier: Apache-2.0
// Which rows are fitted for the result, and which splits validate it.
#pragma once

#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "kinfer/evidence/calibration/calibration_facts.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

struct ValidationPlan {
  std::vector<int> fitted;
  std::vector<Split> validation_splits;
  HoldoutScheme scheme;
  bool fits_all_rows = true;  ///< false: the result is fitted on the train rows of the only split
};

/// Rows linked by a ball-bar, and rows of one pose (repeated, or with different fixtures: stations, anchors), stay on
/// one side of a split. An error if too few rows or different poses are left to fit or to validate.
Result<ValidationPlan> make_validation_plan(const PoseSet& data, const CalibrationOptions& options, Rng rng);

/// k splits of all rows of `data`, with linked rows together: fewer where fewer are not linked, none where all are.
std::vector<Split> make_row_folds(const PoseSet& data, int k, Rng rng);

/// The rows that are not outliers.
std::vector<int> without_outliers(std::vector<int> rows, const std::vector<Outlier>& outliers);

}  // namespace kinfer::calibrate
