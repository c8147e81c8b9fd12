// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/validation_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "kinfer/calibrate/validation/gross_errors.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

PoseSet rows_without_measurements(int rows) {
  PoseSet data;
  data.joints = MatrixXd::Zero(6, rows);
  data.joints.row(0).setLinSpaced(rows, 0.0, 0.1 * rows);
  return data;
}

std::vector<int> first_rows(int count) {
  std::vector<int> rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

ValidationPlan plan_of(const PoseSet& data, const CalibrationOptions& options = {}) {
  const auto plan = make_validation_plan(data, options, Rng(1));
  EXPECT_TRUE(plan) << plan.error().what;
  return plan ? *plan : ValidationPlan{};
}

std::string refusal_of(const PoseSet& data, const CalibrationOptions& options = {}) {
  const auto plan = make_validation_plan(data, options, Rng(1));
  return plan ? "(accepted)" : plan.error().what;
}

/// Every row is held out once, and fitted in all other splits.
void expect_cross_validation(const std::vector<Split>& splits, int rows) {
  std::vector<int> held_out;
  for (const Split& split : splits) {
    EXPECT_EQ(split.train.size() + split.holdout.size(), static_cast<std::size_t>(rows));
    EXPECT_TRUE(std::ranges::is_sorted(split.train));
    held_out.insert(held_out.end(), split.holdout.begin(), split.holdout.end());
  }
  std::ranges::sort(held_out);
  EXPECT_EQ(held_out, first_rows(rows));
}

TEST(ValidationPlan, ByDefaultEveryRowIsHeldOutOnceInFiveFolds) {
  const ValidationPlan plan = plan_of(rows_without_measurements(42));
  EXPECT_TRUE(plan.fits_all_rows);
  EXPECT_EQ(plan.fitted, first_rows(42));
  ASSERT_EQ(plan.validation_splits.size(), 5U);
  expect_cross_validation(plan.validation_splits, 42);
  EXPECT_EQ(std::get<HoldoutFolds>(plan.scheme).folds, 5);
}

TEST(ValidationPlan, ThereAreNoMoreFoldsThanRows) {
  const ValidationPlan plan = plan_of(rows_without_measurements(7), {.holdout = CrossValidation{10}});
  EXPECT_EQ(plan.validation_splits.size(), 7U);
  expect_cross_validation(plan.validation_splits, 7);
}

TEST(ValidationPlan, AnOffsetRefitToFewRowsHoldsThemOutOneAtATime) {
  const CalibrationOptions refit{.parameters = JointOffsetParameters{}};
  EXPECT_EQ(plan_of(rows_without_measurements(12), refit).validation_splits.size(), 12U);
  EXPECT_EQ(plan_of(rows_without_measurements(13), refit).validation_splits.size(), 5U);
  EXPECT_EQ(plan_of(rows_without_measurements(12)).validation_splits.size(), 5U);
}

TEST(ValidationPlan, AFractionIsNeverFitted) {
  const ValidationPlan plan = plan_of(rows_without_measurements(50), {.holdout = HeldOutFraction{0.3}});
  EXPECT_FALSE(plan.fits_all_rows);
  ASSERT_EQ(plan.validation_splits.size(), 1U);
  EXPECT_EQ(plan.validation_splits[0].holdout.size(), 15U);
  EXPECT_EQ(plan.fitted, plan.validation_splits[0].train);
  EXPECT_EQ(std::get<HoldoutFraction>(plan.scheme).fraction, 0.3);
}

TEST(ValidationPlan, LabelsTakePrecedenceOverFoldsButNotOverAFraction) {
  PoseSet data = rows_without_measurements(20);
  data.set.assign(20, SplitLabel::train);
  for (const int row : {3, 7, 19}) data.set[static_cast<std::size_t>(row)] = SplitLabel::holdout;
  for (const HoldoutChoice& choice : {HoldoutChoice(CrossValidation{}), HoldoutChoice(HeldOutByLabel{})}) {
    const ValidationPlan plan = plan_of(data, {.holdout = choice});
    EXPECT_TRUE(std::holds_alternative<HoldoutLabels>(plan.scheme));
    EXPECT_EQ(plan.validation_splits.at(0).holdout, (std::vector{3, 7, 19}));
    EXPECT_EQ(plan.fitted.size(), 17U);
  }
  EXPECT_EQ(plan_of(data, {.holdout = HeldOutFraction{0.5}}).fitted.size(), 10U);
  std::ranges::fill(data.set, SplitLabel::train);
  EXPECT_EQ(plan_of(data).validation_splits.size(), 5U) << "nothing is labelled holdout";
  EXPECT_EQ(refusal_of(data, {.holdout = HeldOutByLabel{}}), "no row is marked holdout in a column called set");
}

TEST(ValidationPlan, TooFewRowsAreAnError) {
  EXPECT_EQ(refusal_of(rows_without_measurements(3)),
            "3 rows are left to fit; a calibration needs at least 4 (20 or more are better)");
  EXPECT_EQ(refusal_of(rows_without_measurements(1)),
            "1 rows are too few to fit and validate a calibration; at least 4 beside those held out are needed");
  EXPECT_EQ(refusal_of(rows_without_measurements(8), {.holdout = HeldOutFraction{0.6}}),
            "3 rows are left to fit; a calibration needs at least 4 (20 or more are better)");
  EXPECT_EQ(refusal_of(rows_without_measurements(4), {.holdout = CrossValidation{2}}),
            "4 rows are too few to fit and validate a calibration; at least 4 beside those held out are needed");
  EXPECT_EQ(refusal_of(rows_without_measurements(4), {.holdout = CrossValidation{4}}), "(accepted)");
}

TEST(ValidationPlan, OnePoseMeasuredAgainAndAgainIsTooLittle) {
  PoseSet data = rows_without_measurements(200);
  for (Eigen::Index row = 1; row < 200; ++row) data.joints.col(row) = data.joints.col(0);
  EXPECT_EQ(refusal_of(data),
            "200 rows of one pose are too few to fit and validate a calibration; at least 4 different poses beside "
            "those held out are needed");
  for (Eigen::Index row = 0; row < 200; ++row) data.joints(1, row) = 0.5 * static_cast<double>(row % 3);
  EXPECT_EQ(refusal_of(data),
            "200 rows of 3 poses are too few to fit and validate a calibration; at least 4 different poses beside "
            "those held out are needed");
  for (Eigen::Index row = 0; row < 200; ++row) data.joints(1, row) = 0.5 * static_cast<double>(row % 4);
  EXPECT_EQ(plan_of(data).validation_splits.size(), 4U);
}

TEST(ValidationPlan, RowsLinkedByABallBarStayTogether) {
  PoseSet data = rows_without_measurements(30);
  for (const auto& [row, other] : {std::pair{0, 9}, {9, 17}, {2, 3}, {17, 28}}) data.pairs.push_back({row, other, 0.5});
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<Split> splits = make_row_folds(data, 4, Rng(seed));
    expect_cross_validation(splits, 30);
    for (const Split& split : splits) {
      const std::set<int> held_out(split.holdout.begin(), split.holdout.end());
      for (const PairDistance& pair : data.pairs)
        EXPECT_EQ(held_out.contains(pair.row), held_out.contains(pair.other)) << pair.row << "-" << pair.other;
    }
  }
}

TEST(ValidationPlan, FewLinkedRowsMakeFewFolds) {
  PoseSet data = rows_without_measurements(4);
  data.pairs = {{0, 1, 0.5}, {2, 3, 0.5}};
  EXPECT_EQ(make_row_folds(data, 5, Rng(1)).size(), 2U);
  data.pairs.push_back({1, 2, 0.5});
  EXPECT_TRUE(make_row_folds(data, 5, Rng(1)).empty());
}

TEST(ValidationPlan, DependsOnItsSeedOnly) {
  const PoseSet data = rows_without_measurements(40);
  const auto folds_of = [&](std::uint64_t seed) { return make_row_folds(data, 5, Rng(seed))[0].holdout; };
  EXPECT_EQ(folds_of(3), folds_of(3));
  EXPECT_NE(folds_of(3), folds_of(4));
}

TEST(WithoutOutliers, RemovesTheirRowsOnly) {
  EXPECT_EQ(without_outliers({1, 4, 6, 9}, {{.row = 4}, {.row = 5}, {.row = 9}}), (std::vector{1, 6}));
  EXPECT_EQ(without_outliers({1, 4}, {}), (std::vector{1, 4}));
}

ValidationPlan plan_with_holdout(const std::vector<int>& rows) {
  return {.fitted = {}, .validation_splits = {{.train = {}, .holdout = rows}}, .scheme = {}};
}

TEST(ExcludedRows, AreSuspectHeldOutRowsUnlessTheyAreAThird) {
  const ValidationPlan plan = plan_with_holdout({1, 3, 5, 7, 9, 11, 13});
  const ExcludedRows few = select_excluded_rows({{.row = 9}, {.row = 2}, {.row = 3}, {.row = 9}}, plan);
  EXPECT_EQ(few.rows, (std::vector{3, 9})) << "row 2 is fitted, row 9 counts once";
  EXPECT_FALSE(few.too_many);
  const ExcludedRows many = select_excluded_rows({{.row = 9}, {.row = 3}, {.row = 13}}, plan);
  EXPECT_TRUE(many.rows.empty());
  EXPECT_TRUE(many.too_many);
  EXPECT_EQ(many.suspect_count, 3U);
  EXPECT_FALSE(select_excluded_rows({}, plan).too_many);
}

std::vector<RowErrors> held_out_rows(const std::vector<double>& gain) {
  std::vector<RowErrors> rows;
  for (std::size_t i = 0; i < gain.size(); ++i)
    rows.push_back({.row = static_cast<int>(i), .before = 1e-3 + gain[i], .after = 1e-3, .held_out = true});
  return rows;
}

TEST(ChanceOfImprovement, IsThatOfThePairedTTest) {
  const PoseSet data = rows_without_measurements(5);
  const std::vector<double> gain{1e-3, 2e-3, 3e-3, 4e-3, 5e-3};  // mean 3, standard error 0.7071: t = 4.243
  EXPECT_NEAR(*chance_of_improvement(held_out_rows(gain), {}, data), 0.00662, 1e-5);
  const std::vector<double> loss{-1e-3, -2e-3, -3e-3, -4e-3, -5e-3};
  EXPECT_NEAR(*chance_of_improvement(held_out_rows(loss), {}, data), 1.0 - 0.00662, 1e-5);
  EXPECT_NEAR(*chance_of_improvement(held_out_rows(gain), {0, 1, 2}, data),
              0.5 * (1.0 - 2.0 / 3.14159265 * std::atan(9.0)), 1e-6)
      << "two rows are left: t = 9 with one degree of freedom";
  EXPECT_FALSE(chance_of_improvement(held_out_rows(gain), {0, 1, 2, 3}, data).has_value());
}

TEST(ChanceOfImprovement, CountsThePosesAndNotTheirRepetitions) {
  PoseSet data = rows_without_measurements(60);
  std::vector<double> gain;
  for (int row = 0; row < 60; ++row) {
    data.joints(0, row) = 0.1 * (row % 3);
    gain.push_back(1e-3 * (row % 3 - 0.5));
  }
  const double once =
      *chance_of_improvement(held_out_rows({-0.5e-3, 0.5e-3, 1.5e-3}), {}, rows_without_measurements(3));
  EXPECT_NEAR(*chance_of_improvement(held_out_rows(gain), {}, data), once, 1e-12);
}

TEST(PrimaryMeasurementKind, IsTheFirstLengthThatWasMeasured) {
  PoseSet data = rows_without_measurements(3);
  EXPECT_FALSE(primary_measurement_kind(data));
  data.tilts.push_back({});
  data.orientations.push_back({});
  EXPECT_FALSE(primary_measurement_kind(data)) << "angles are no lengths";
  const auto measured = [&](auto& list, auto measurement) {
    list.assign(4, measurement);
    return primary_measurement_kind(data);
  };
  EXPECT_EQ(measured(data.plane_contacts, PlaneContact{}), kind_of<PlaneContact>);
  EXPECT_EQ(measured(data.pairs, PairDistance{0, 1, 0.5}), kind_of<PairDistance>);
  EXPECT_EQ(measured(data.distances, DistanceMeasurement{}), kind_of<DistanceMeasurement>);
  EXPECT_EQ(measured(data.contacts, SocketContact{}), kind_of<SocketContact>);
  EXPECT_EQ(measured(data.points, PointMeasurement{}), kind_of<PointMeasurement>);
}

TEST(PrimaryMeasurementKind, IsNoneWhereFixturesArePlacedAndNoMore) {
  PoseSet data = rows_without_measurements(3);
  data.contacts = {{0, 0}, {1, 1}, {2, 2}};
  data.plane_contacts = {{0, 0}, {1, 0}, {2, 0}};
  EXPECT_FALSE(primary_measurement_kind(data));
  data.contacts[2].socket = 1;
  EXPECT_EQ(primary_measurement_kind(data), kind_of<SocketContact>);
}

}  // namespace
}  // namespace kinfer
