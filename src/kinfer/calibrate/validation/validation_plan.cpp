// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/validation_plan.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace kinfer::calibrate {
namespace {

bool has_held_out_labels(const PoseSet& data) {
  return std::find(data.set.begin(), data.set.end(), SplitLabel::holdout) != data.set.end();
}

ValidationPlan plan_by_labels(const PoseSet& data) {
  Split split;
  for (int row = 0; row < data.rows(); ++row)
    (data.set[row] == SplitLabel::holdout ? split.holdout : split.train).push_back(row);
  return {split.train, {split}, "rows marked holdout", false};
}

/// Groups of linked rows, each ascending.
std::vector<std::vector<int>> linked_row_groups(const PoseSet& data) {
  std::vector<int> first(data.rows());  // smallest row of the group
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int row) {
    while (first[row] != row) row = first[row];
    return row;
  };
  for (const PairDistance& pair : data.pairs) {
    const int a = root(pair.row), b = root(pair.other);
    first[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<int>> groups(data.rows());
  for (int row = 0; row < data.rows(); ++row) groups[root(row)].push_back(row);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

std::vector<int> rows_of(const std::vector<std::vector<int>>& groups, const std::vector<int>& chosen) {
  std::vector<int> rows;
  for (const int group : chosen) rows.insert(rows.end(), groups[group].begin(), groups[group].end());
  std::sort(rows.begin(), rows.end());
  return rows;
}

Split split_to_rows(const std::vector<std::vector<int>>& groups, const Split& split) {
  return {rows_of(groups, split.train), rows_of(groups, split.holdout)};
}

Result<ValidationPlan> draft_plan(const PoseSet& data, const HoldoutChoice& choice, Rng rng) {
  const std::vector<std::vector<int>> groups = linked_row_groups(data);
  const auto count = static_cast<int>(groups.size());
  if (const auto* part = std::get_if<HeldOutFraction>(&choice)) {
    const Split split = split_to_rows(groups, random_split(count, part->fraction, rng));
    return ValidationPlan{
        split.train, {split}, fmt::format("{:.0f} % of the rows, drawn at random", 100.0 * part->fraction), false};
  }
  if (has_held_out_labels(data)) return plan_by_labels(data);
  if (std::holds_alternative<HeldOutByLabel>(choice)) return error("no row is marked holdout in a column called set");
  const int k = std::min(std::get<CrossValidation>(choice).folds, count);
  if (k < 2) return error("{} rows are too few to fit and prove a calibration; at least 4 are needed", data.rows());
  return ValidationPlan{all_rows(data), make_row_folds(data, k, rng), fmt::format("{}-fold cross-validation", k), true};
}

}  // namespace

std::vector<int> all_rows(const PoseSet& data) {
  std::vector<int> rows(data.rows());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

std::vector<int> without(std::vector<int> rows, const std::vector<int>& others) {
  const std::set<int> unwanted(others.begin(), others.end());
  std::erase_if(rows, [&](int row) { return unwanted.contains(row); });
  return rows;
}

std::vector<int> without(std::vector<int> rows, const std::vector<Outlier>& outliers) {
  std::vector<int> wrong;
  for (const Outlier& outlier : outliers) wrong.push_back(outlier.row);
  return without(std::move(rows), wrong);
}

std::vector<Split> make_row_folds(const PoseSet& data, int k, Rng rng) {
  const std::vector<std::vector<int>> groups = linked_row_groups(data);
  std::vector<Split> splits;
  for (const Split& split : folds(static_cast<int>(groups.size()), k, rng))
    splits.push_back(split_to_rows(groups, split));
  return splits;
}

Result<ValidationPlan> make_validation_plan(const PoseSet& data, const HoldoutChoice& choice, Rng rng) {
  KINFER_TRY(plan, draft_plan(data, choice, rng));
  // Each pose gives at most six equations; base and tool alone are nine unknowns, and one row must validate the result.
  constexpr int fewest = 4;
  if (static_cast<int>(plan.fitted.size()) < fewest)
    return error("{} rows are left to fit; a calibration needs at least {} (20 or more are better)", plan.fitted.size(),
                 fewest);
  for (const Split& split : plan.proofs)
    if (split.train.size() < 3)
      return error("{} rows are too few to fit and prove a calibration; at least 4 are needed", data.rows());
  return plan;
}

}  // namespace kinfer::calibrate
