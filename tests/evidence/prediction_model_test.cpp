// SPDX-License-Identifier: Apache-2.0
// The measured region of a prediction.
#include "kinfer/evidence/calibration/prediction_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
  model.growth = 0.4 * model.model_error;
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

TEST(ModelErrorAt, GrowsQuadraticallyWithTheDistanceFromTheFittedRows) {
  const PredictionModel model = measured_region();
  EXPECT_EQ(model_error_at(model, model.rows.col(7)), model.model_error);
  const VectorXd far = VectorXd::Constant(4, 50.0);
  const double distance = region_distance(model, far);
  EXPECT_TRUE(model_error_at(model, far).isApprox((1.0 + 0.4 * distance * distance) * model.model_error, 1e-12));
}

}  // namespace
}  // namespace kinfer
