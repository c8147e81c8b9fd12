// SPDX-License-Identifier: Apache-2.0
// An instrument on a shaking stand: what the covariance of the whole pose gains.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/simulate/pose_set.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

constexpr Instrument camera{.sigma = 10e-6, .sigma_angle = 5e-6, .ppm = 0.0};
constexpr double shake = 100e-6;  // [rad]: 0.3 mm at the robot

struct Robot {
  Chain nominal = nominal_robot(), truth;
};

Robot robot(int seed) {
  Robot made;
  made.truth = with_random_errors(made.nominal, {}, Rng(seed));
  made.truth.base = Frame::from_pose(Pose::from_xyz_rpy({2.4, -2.2, 0.35}, {0.02, -0.03, 2.3}));
  return made;
}

PoseSet seen(const Robot& made, int seed) {
  return simulate_pose_set(made.truth, {.poses = 40, .instrument = camera, .measured = Measured::poses, .shake = shake},
                           Rng(seed))
      .value();
}

PoseSet by_blocks(PoseSet set) {
  for (OrientationMeasurement& measured : set.orientations) measured.covariance_with_point.reset();
  return set;
}

Calibration fitted(const Robot& made, const PoseSet& data) {
  return calibrate_robot({made.nominal, {}, std::nullopt, data}, {.model = FixedModel{}}, Rng(1)).value();
}

/// Mean error on held-out poses [m] with the base aligned: the stand's mean rotation moves the base.
double unseen_error(const Robot& made, const PoseSet& data) {
  const PoseSet elsewhere = simulate_pose_set(made.truth, {.poses = 300, .instrument = noise_free}, Rng(77)).value();
  const std::vector<Pose> found = true_poses(fitted(made, data).estimate.chain, elsewhere);
  std::vector<Vec3> from, to;
  for (const PointMeasurement& point : elsewhere.points)
    from.push_back(found[point.row].position), to.push_back(point.position);
  const Pose moved = align_points(to, from);
  std::vector<double> errors;
  for (std::size_t i = 0; i < to.size(); ++i) errors.push_back((moved * from[i] - to[i]).norm());
  return mean(errors);
}

TEST(PoseCovariance, ErrorsOfAShakenCameraHaveTheCovarianceThatItsFileStates) {
  const Robot made = robot(1);
  const PoseSet set =
      simulate_pose_set(made.truth, {.poses = 2000, .instrument = camera, .measured = Measured::poses, .shake = shake},
                        Rng(3))
          .value();
  const ParameterSet nothing;
  VectorXd r;
  const Weights weights = weights_of(set, camera);
  ASSERT_EQ(weights.couplings.size(), 2000U);
  pose_residuals(made.truth, nothing, set, weights).evaluate(VectorXd(0), r, nullptr);
  const Eigen::Index n = 6000;
  MatrixXd six(6, 2000);
  six.topRows(3) = r.head(n).reshaped(3, 2000), six.bottomRows(3) = r.tail(n).reshaped(3, 2000);
  const MatrixXd scatter = six * six.transpose() / 2000.0;
  EXPECT_LT((scatter - MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 5.0 * std::sqrt(2.0 / 2000.0));
}

TEST(PoseCovariance, SixRowsTogetherBeatPointAndOrientationApart) {
  std::vector<double> together, apart;
  for (int seed = 1; seed <= 10; ++seed) {
    const Robot made = robot(seed);
    const PoseSet data = seen(made, 500 + seed);
    together.push_back(unseen_error(made, data)), apart.push_back(unseen_error(made, by_blocks(data)));
  }
  EXPECT_LT(mean(together), 0.7 * mean(apart));
}

/// Everything in the world rotated and moved, covariances included.
PoseSet moved(PoseSet set, const Pose& to) {
  const auto turned = [&](const std::optional<Mat3>& axes) {
    return Mat3(to.rotation * axes.value_or(Mat3::Identity()));
  };
  for (PointMeasurement& point : set.points) point.position = to * point.position, point.axes = turned(point.axes);
  for (OrientationMeasurement& measured : set.orientations) {
    measured.orientation = Quat(to.rotation) * measured.orientation, measured.axes = turned(measured.axes);
    measured.covariance_with_point = Mat3(to.rotation * *measured.covariance_with_point * to.rotation.transpose());
  }
  return set;
}

TEST(PoseCovariance, RotatingTheWorldWithAllCovariancesChangesNoFit) {
  const Robot made = robot(2);
  const PoseSet data = seen(made, 9);
  const Pose to = Pose::from_xyz_rpy({0.3, 1.2, -0.4}, {0.5, -0.8, 2.0});
  Robot there = made;
  there.nominal.base = Frame::from_pose(to * made.nominal.base.pose());
  const Calibration here = fitted(made, data), away = fitted(there, moved(data, to));
  for (std::size_t k = 0; k < here.estimate.values.size(); ++k) {
    const ParameterEstimate &a = here.estimate.values[k], &b = away.estimate.values[k];
    if (a.name.starts_with("base_")) continue;  // rotations of the base have priors about the world's axes
    EXPECT_NEAR(a.value, b.value, 0.02 * a.sd + 1e-9) << a.name;
    EXPECT_NEAR(a.sd, b.sd, 0.02 * a.sd) << a.name;
  }
}

TEST(PoseCovariance, OnlyBadPointsAndOrientationsOfCoupledPosesAreRejected) {
  const Robot made = robot(3);
  PoseSet data = seen(made, 21);
  data.points[5].position += Vec3(3e-3, 0, 0);
  data.orientations[17].orientation = quat_exp(Vec3(0, 0.02, 0)) * data.orientations[17].orientation;
  const Calibration found = fitted(made, data);
  ASSERT_EQ(found.estimate.outliers.size(), 2U);
  EXPECT_EQ(found.estimate.outliers[0].row, 5);
  const auto kinds = [&](int i) {
    std::vector<MeasurementKind> list;
    for (const OutlierReason& reason : found.estimate.outliers[i].reasons) list.push_back(reason.kind);
    return list;
  };
  EXPECT_EQ(kinds(0), std::vector{kind_of<PointMeasurement>}) << "its orientation is good";
  EXPECT_EQ(found.estimate.outliers[1].row, 17);
  EXPECT_EQ(kinds(1), std::vector{kind_of<OrientationMeasurement>}) << "its point is good";
}

}  // namespace
}  // namespace kinfer
