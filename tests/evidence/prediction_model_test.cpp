// SPDX-License-Identifier: Apache-2.0
// The measured region of a prediction.
#include "kinfer/evidence/calibration/prediction_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "support/random.hpp"

namespace kinfer {
namespace {

using test::random_matrix;

PredictionModel measured_region() {
  PredictionModel model;
  model.rows = random_matrix(4, 30, 5);
  model.spread = Eigen::Vector4d(0.5, 1.0, 0.2, 2.0);
  model.reach = 0.7;
  model.model_error.diagonal() << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  model.outside_error = 0.4 * model.model_error;
  model.edge = 0.9;
  return model;
}

/// The nearest row, one by one.
double slow_distance(const PredictionModel& model, const VectorXd& q) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < model.rows.cols(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < q.size(); ++k) sum += std::pow((q[k] - model.rows(k, i)) / model.spread[k], 2);
    least = std::min(least, std::sqrt(sum) / model.reach);
  }
  return least;
}

TEST(RegionDistance, IsThatToTheNearestRow) {
  const PredictionModel model = measured_region();
  for (std::uint64_t i = 0; i < 50; ++i) {
    const VectorXd q = 2.0 * random_matrix(4, 1, 100 + i);
    EXPECT_NEAR(region_distance(model, q), slow_distance(model, q), 1e-12);
  }
  for (Eigen::Index i = 0; i < 30; ++i) EXPECT_EQ(region_distance(model, model.rows.col(i)), 0.0);
}

TEST(RegionDistance, DoesNotDependOnTheUnitsOfTheJoints) {
  const PredictionModel model = measured_region();
  PredictionModel other = model;
  const Eigen::Vector4d unit(57.3, 1000.0, 1.0, 1e-3);
  other.rows = unit.asDiagonal() * model.rows;
  other.spread = unit.cwiseProduct(model.spread);
  const VectorXd q = random_matrix(4, 1, 9);
  EXPECT_NEAR(region_distance(other, unit.cwiseProduct(q)), region_distance(model, q), 1e-12);
}

TEST(RegionDistance, GrowsByLessThanTheWayGone) {
  const PredictionModel model = measured_region();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const VectorXd a = random_matrix(4, 1, 200 + i), b = random_matrix(4, 1, 300 + i);
    const double way = (a - b).cwiseQuotient(model.spread).norm() / model.reach;
    EXPECT_LE(std::abs(region_distance(model, a) - region_distance(model, b)), way + 1e-12);
  }
}

TEST(RegionDistance, WithoutRowsEverythingCountsAsMeasured) {
  PredictionModel model = measured_region();
  model.rows.resize(4, 0);
  EXPECT_EQ(region_distance(model, VectorXd::Constant(4, 100.0)), 0.0);
  EXPECT_EQ(model_error_at(model, VectorXd::Constant(4, 100.0)), model.model_error);
}

TEST(CorrectionWeight, FallsFromOneAtTheEdgeOfTheMeasuredRegionToZero) {
  PredictionModel model = measured_region();
  const VectorXd inside = model.rows.col(7), far = VectorXd::Constant(4, 50.0);
  EXPECT_EQ(correction_weight(model, far), 1.0) << "nothing changes beyond";
  model.beyond = VectorXd::Ones(3);
  EXPECT_EQ(correction_weight(model, inside), 1.0);
  double before = 1.0;
  for (int k = 0; k <= 40; ++k) {
    const VectorXd q = inside + (k / 40.0) * (far - inside);
    const double weight = correction_weight(model, q);
    if (region_distance(model, q) <= 1.0) EXPECT_EQ(weight, 1.0);
    EXPECT_GT(weight, 0.0);
    if (k > 20) EXPECT_LE(weight, before);
    before = weight;
  }
  EXPECT_LT(correction_weight(model, far), 0.01);
}

/// By sorting all rows, one coordinate after the other.
double slow_one_sidedness(const PredictionModel& model, const VectorXd& q) {
  std::vector<std::pair<double, Eigen::Index>> by_distance;
  for (Eigen::Index i = 0; i < model.rows.cols(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < q.size(); ++k) sum += std::pow((q[k] - model.rows(k, i)) / model.spread[k], 2);
    if (sum > 0.0) by_distance.emplace_back(sum, i);
  }
  std::ranges::sort(by_distance);
  const std::size_t count = std::min<std::size_t>(15, by_distance.size() / 2);
  double offset = 0.0, squares = 0.0;
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    double mean = 0.0;
    for (std::size_t i = 0; i < count; ++i) mean += model.rows(k, by_distance[i].second) / static_cast<double>(count);
    offset += std::pow((q[k] - mean) / model.spread[k], 2);
    for (std::size_t i = 0; i < count; ++i)
      squares += std::pow((model.rows(k, by_distance[i].second) - mean) / model.spread[k], 2);
  }
  return std::sqrt(offset / (squares / static_cast<double>(count)));
}

TEST(OneSidedness, IsThatOfTheNearestRows) {
  const PredictionModel model = measured_region();
  for (std::uint64_t i = 0; i < 50; ++i) {
    const VectorXd q = 2.0 * random_matrix(4, 1, 100 + i);
    EXPECT_NEAR(one_sidedness(model, q), slow_one_sidedness(model, q), 1e-9);
  }
  EXPECT_NEAR(one_sidedness(model, model.rows.col(3)), slow_one_sidedness(model, model.rows.col(3)), 1e-9);
}

TEST(OneSidedness, IsSmallInAGapAndLargeOutside) {
  PredictionModel model;
  model.rows = MatrixXd(2, 200);
  for (Eigen::Index i = 0; i < 200; ++i)  // two clouds with a gap between them
    model.rows.col(i) =
        0.1 * random_matrix(2, 1, 1 + static_cast<std::uint64_t>(i)).col(0) + Eigen::Vector2d(i % 2 ? 1.0 : -1.0, 0.0);
  model.spread = Eigen::Vector2d(1.0, 0.1);
  EXPECT_LT(one_sidedness(model, Eigen::Vector2d(0.0, 0.0)), 1.5);
  EXPECT_GT(one_sidedness(model, Eigen::Vector2d(3.0, 0.0)), 5.0);
}

TEST(OneSidedness, FewOrEqualRowsSayNothingAndDoNoHarm) {
  PredictionModel model = measured_region();
  const VectorXd q = random_matrix(4, 1, 3);
  model.rows = model.rows.leftCols(3).eval();
  EXPECT_EQ(one_sidedness(model, q), 0.0);
  model.rows = q.replicate(1, 20);
  EXPECT_EQ(outside_share(model, q), 0.0);
  EXPECT_EQ(outside_share(model, VectorXd(q.array() + 1.0)), 1.0) << "all rows at one place";
}

TEST(ModelErrorAt, RisesToTheOutsideErrorAndNoFurther) {
  const PredictionModel model = measured_region();
  const VectorXd middle = model.rows.rowwise().mean(), far = VectorXd::Constant(4, 1e4);
  double before = 0.0;
  for (int k = 0; k <= 40; ++k) {
    const double share = outside_share(model, middle + std::pow(k / 40.0, 4) * (far - middle));
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    if (k > 20) EXPECT_GE(share, before);
    before = share;
  }
  EXPECT_TRUE(model_error_at(model, far).isApprox(1.4 * model.model_error, 1e-9));
}

}  // namespace
}  // namespace kinfer
