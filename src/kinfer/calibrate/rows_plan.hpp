// Which rows are fitted for the result, and which splits prove it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer {

struct RowsPlan {
  std::vector<int> fitted;
  std::vector<Split> proofs;
  std::string words;                 ///< "5-fold cross-validation"
  bool result_sees_all_rows = true;  ///< false: the fitted rows are those of the only proof
};

/// Rows that a ball-bar joins stay on one side of a split. An error where too few rows are left to fit or to prove.
Result<RowsPlan> plan_of_rows(const PoseSet& data, const HoldoutChoice& choice, Rng rng);

/// k splits of the rows 0 .. rows-1 of `data`, joined rows together.
std::vector<Split> folds_of(const PoseSet& data, int k, Rng rng);

std::vector<int> all_rows(const PoseSet& data);

/// The rows without some, or without those that a fit does not believe.
std::vector<int> without(std::vector<int> rows, const std::vector<int>& others);
std::vector<int> without(std::vector<int> rows, const std::vector<Outlier>& outliers);

}  // namespace kinfer
