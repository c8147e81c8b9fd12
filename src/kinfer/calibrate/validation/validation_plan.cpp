// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/validation_plan.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/measurement/commanded_poses.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

bool has_held_out_labels(const PoseSet& data) {
  return std::find(data.set.begin(), data.set.end(), SplitLabel::holdout) != data.set.end();
}

/// An error where nothing is left of the held-out rows: copies of fitted rows have lost their measurements.
Result<ValidationPlan> plan_by_labels(const PoseSet& data) {
  Split split;
  for (int row = 0; row < data.rows(); ++row)
    (data.set[row] == SplitLabel::holdout ? split.holdout : split.train).push_back(row);
  if (has_measurements(data) && !has_measurements(select(data, split.holdout)))
    return error("no held-out row has a measurement that is not a copy of a fitted row's: hold out other poses");
  return ValidationPlan{split.train, {split}, HoldoutLabels{}, false};
}

/// Calls link(row, other) for rows of one pose that several fixtures see (stations, anchors): the same joint positions
/// with different fixtures. Each would reveal the error of the others if only one of them were held out.
template <class Link>
void link_sights_of_one_pose(const PoseSet& data, Link link) {
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if constexpr (RefersToFixture<M>) {
      std::map<std::vector<double>, const M*> first;
      for (const M& m : list) {
        const auto q = data.joints.col(m.row);
        const auto [at, is_new] = first.try_emplace({q.begin(), q.end()}, &m);
        if (!is_new && at->second->*M::fixture_index != m.*M::fixture_index) link(at->second->row, m.row);
      }
    }
  });
}

/// Calls link(row, other) for rows of one pose: with its copy among the fitted rows, a held-out row would show how well
/// a pose repeats and not how well another one is predicted. Not beside ball-bars: all bars from one reference pose
/// would be linked.
template <class Link>
void link_repeated_poses(const PoseSet& data, Link link) {
  if (!data.pairs.empty()) return;
  std::map<int, int> first;
  const std::vector<int> poses = commanded_poses(data);
  for (int row = 0; row < data.rows(); ++row)
    link(first.try_emplace(poses[static_cast<std::size_t>(row)], row).first->second, row);
}

/// `poses`: the pose of each row of the data.
int distinct_poses(const std::vector<int>& poses, const std::vector<int>& rows) {
  std::set<int> distinct;
  for (const int row : rows) distinct.insert(poses[static_cast<std::size_t>(row)]);
  return static_cast<int>(distinct.size());
}

/// Groups of linked rows, each ascending.
std::vector<std::vector<int>> linked_row_groups(const PoseSet& data) {
  std::vector<int> first(data.rows());  // smallest row of the group
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int row) {
    while (first[row] != row) row = first[row];
    return row;
  };
  const auto link = [&](int row, int other) {
    const int a = root(row), b = root(other);
    first[std::max(a, b)] = std::min(a, b);
  };
  for (const PairDistance& pair : data.pairs) link(pair.row, pair.other);
  link_sights_of_one_pose(data, link);
  link_repeated_poses(data, link);
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

std::vector<Split> folds_of_groups(const std::vector<std::vector<int>>& groups, int k, Rng rng) {
  std::vector<Split> splits;
  for (const Split& split : folds(static_cast<int>(groups.size()), k, rng))
    splits.push_back(split_to_rows(groups, split));
  return splits;
}

int fold_count(const PoseSet& data, const CrossValidation& choice, const ParameterChoice& parameters) {
  if (choice.folds) return *choice.folds;
  const bool leave_one_out =
      std::holds_alternative<JointOffsetParameters>(parameters) && data.rows() <= thresholds::leave_one_out_rows;
  return leave_one_out ? static_cast<int>(data.rows()) : thresholds::default_folds;
}

Error too_few_rows(const PoseSet& data) {
  if (const int poses = distinct_poses(commanded_poses(data), all_rows(data)); poses < data.rows())
    return {fmt::format(
        "{} rows of {} are too few to fit and validate a calibration; at least {} different poses beside those held "
        "out are needed",
        data.rows(), poses == 1 ? "one pose" : fmt::format("{} poses", poses), thresholds::min_fitted_rows)};
  return {
      fmt::format("{} rows are too few to fit and validate a calibration; at least {} beside those held out are needed",
                  data.rows(), thresholds::min_fitted_rows)};
}

Result<ValidationPlan> draft_plan(const PoseSet& data, const CalibrationOptions& options, Rng rng) {
  const std::vector<std::vector<int>> groups = linked_row_groups(data);
  const auto count = static_cast<int>(groups.size());
  if (const auto* part = std::get_if<HeldOutFraction>(&options.holdout)) {
    const Split split = split_to_rows(groups, random_split(count, part->fraction, rng));
    return ValidationPlan{split.train, {split}, HoldoutFraction{part->fraction}, false};
  }
  if (has_held_out_labels(data)) return plan_by_labels(data);
  const auto* folds = std::get_if<CrossValidation>(&options.holdout);
  if (!folds) return error("no row is marked holdout in a column called set");
  const int k = std::min(fold_count(data, *folds, options.parameters), count);
  if (k < 2) return forward_error(too_few_rows(data));
  return ValidationPlan{all_rows(data), folds_of_groups(groups, k, rng), HoldoutFolds{k}, true};
}

}  // namespace

std::vector<int> without_outliers(std::vector<int> rows, const std::vector<Outlier>& outliers) {
  std::vector<int> wrong;
  for (const Outlier& outlier : outliers) wrong.push_back(outlier.row);
  return without(std::move(rows), wrong);
}

std::vector<Split> make_row_folds(const PoseSet& data, int k, Rng rng) {
  const std::vector<std::vector<int>> groups = linked_row_groups(data);
  if (groups.size() < 2) return {};
  return folds_of_groups(groups, std::min(k, static_cast<int>(groups.size())), rng);
}

Result<ValidationPlan> make_validation_plan(const PoseSet& data, const CalibrationOptions& options, Rng rng) {
  KINFER_TRY(plan, draft_plan(data, options, rng));
  if (static_cast<int>(plan.fitted.size()) < thresholds::min_fitted_rows)
    return error("{} rows are left to fit; a calibration needs at least {} (20 or more are better)", plan.fitted.size(),
                 thresholds::min_fitted_rows);
  const std::vector<int> poses = commanded_poses(data);
  if (distinct_poses(poses, plan.fitted) < thresholds::min_fitted_rows) return forward_error(too_few_rows(data));
  for (const Split& split : plan.validation_splits)
    if (distinct_poses(poses, split.train) < thresholds::min_training_poses) return forward_error(too_few_rows(data));
  return plan;
}

}  // namespace kinfer::calibrate
