// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/bootstrap.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/estimate/poses/point_fit.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

struct Case {
  Chain nominal = er20(), truth = with_table3_errors(er20());
  PoseSet data;
  ParameterSet set;
  Weights weights;

  explicit Case(int poses, int seed = 1)
      : data(measured(truth, paper2_poses(poses, tracker), seed)),
        set(paper_dh_parameters(nominal, {}).value()),
        weights(weights_of(data, tracker)) {
    data.orientations.clear();
    weights.of<OrientationMeasurement>().clear();
  }
};

TEST(PointFit, EndsWhereTheFitWithAFixedJacobianEnds) {
  const Case c(50);
  const VectorXd start = pack(c.set, c.nominal);
  const BatchPoints points(c.nominal, c.set, point_table(c.data));
  const LeastSquaresOutcome fast = fit_points(points, c.set, points.weights(inverse_sd(c.weights)), start);
  const LeastSquaresOutcome slow = least_squares(pose_residuals(c.nominal, c.set, c.data, c.weights), start);
  EXPECT_NEAR(fast.cost, slow.cost, 1e-9 * slow.cost);
  for (Eigen::Index k = 0; k < start.size(); ++k)
    EXPECT_NEAR(fast.x[k], slow.x[k], 1e-6 * c.set.free()[k]->prior_sd) << c.set.free()[k]->name;
  MatrixXd normal = fast.normal.matrix, dense = slow.jacobian.transpose() * slow.jacobian;
  dense.triangularView<Eigen::StrictlyUpper>().setZero();
  EXPECT_LT((normal - dense).norm(), 1e-6 * dense.norm());
}

TEST(Bootstrap, SpreadOverResamplesIsThatOfTheCovariance) {
  const Case c(200);
  const Estimate estimate = fit_bundle(c.nominal, c.set, c.data, tracker, {.outliers = Outliers::keep_all});
  const Bootstrap found = bootstrap(estimate.chain, c.set, c.data, c.weights, {.resamples = 400}, Rng(1));
  EXPECT_EQ(found.failed, 0);
  // Directions that only the priors determine do not move with the data: compared where the data dominate.
  for (Eigen::Index k = 0; k < found.sd.size(); ++k) {
    const ParameterEstimate& value = estimate.values[k];
    const double prior_sd = c.set.free()[k]->prior_sd;
    if (value.sd > 0.1 * prior_sd) continue;
    EXPECT_NEAR(found.sd[k] / value.sd, 1.0, 0.35) << value.name;
  }
}

TEST(Bootstrap, ResultDoesNotDependOnTheThreads) {
  const Case c(30);
  const auto with = [&](int threads) {
    return bootstrap(c.truth, c.set, c.data, c.weights, {.resamples = 50, .threads = threads}, Rng(3)).x;
  };
  const MatrixXd one = with(1);
  EXPECT_EQ(one, with(2));
  EXPECT_EQ(one, with(7));
}

TEST(Bootstrap, RefitsByPoseResidualsAndByKernelsAgree) {
  Case c(30);
  const Bootstrap fast = bootstrap(c.truth, c.set, c.data, c.weights, {.resamples = 5}, Rng(3));
  // An orientation without information sends the same problem through the general residuals.
  c.data.orientations.push_back({.row = 0, .orientation = Quat::Identity()});
  c.weights.of<OrientationMeasurement>().push_back(Vec3::Constant(1e9));
  const Bootstrap slow = bootstrap(c.truth, c.set, c.data, c.weights, {.resamples = 5}, Rng(3));
  for (Eigen::Index k = 0; k < fast.x.rows(); ++k)
    EXPECT_LT((fast.x.row(k) - slow.x.row(k)).norm(), 1e-5 * c.set.free()[k]->prior_sd);
}

}  // namespace
}  // namespace kinfer
