// SPDX-License-Identifier: Apache-2.0
// A few poses measured again and again say no more of the model than the same poses measured once: neither held-out
// errors nor predictions may look better than they are.
#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/row_selection.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// An arm whose third gear harmonic [rad] is known to no term.
Chain arm_with_unknown_harmonic(int seed, double unknown) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(seed));
  for (Joint& joint : truth.joints) joint.harmonics = {{3.0, unknown, 0.0}};
  return truth;
}

/// Joint readings scatter, and the tool is where they say.
PoseSet measured_again(const Chain& truth, int poses, int times, double scatter, int seed) {
  const PoseSet once = test::measured(truth, test::paper2_poses(poses, test::noise_free), seed);
  std::vector<int> rows;
  for (int row = 0; row < poses * times; ++row) rows.push_back(row / times);
  PoseSet set = select(once, rows);
  Rng rng(static_cast<std::uint64_t>(seed));
  for (double& q : set.joints.reshaped()) q += scatter * rng.normal();
  for (PointMeasurement& point : set.points) {
    point.position = forward(truth, set.joints.col(point.row)).position;
    for (double& x : point.position) x += test::tracker.sigma * rng.normal();
  }
  return set;
}

/// Errors of fresh poses: their mean [m], and rms in units of the standard deviations that are stated for them.
struct FreshErrors {
  double mean = 0.0, over_sd = 0.0;
};

FreshErrors fresh_errors(const Chain& truth, const Calibration& c, int seed) {
  const PoseSet rows = test::measured(truth, test::paper2_poses(200, test::noise_free), seed);
  const auto poses = deploy::predict_poses(corrected_chain(c), rows).value();
  const auto spread = deploy::predict_uncertainties(corrected_chain(c), *c.prediction, rows).value();
  FreshErrors errors;
  for (const PointMeasurement& point : rows.points) {
    const Vec3 error = point.position - poses[point.row].position;
    errors.mean += error.norm() / 200.0;
    errors.over_sd += error.cwiseAbs2().cwiseQuotient(spread[point.row].position.diagonal()).sum() / 600.0;
  }
  errors.over_sd = std::sqrt(errors.over_sd);
  return errors;
}

TEST(RepeatedPoses, NeitherErrorsNorPredictionsLookBetterThanTheyAre) {
  for (const double scatter : {0.0, 1e-4, 1e-2})
    for (int seed = 1; seed <= 3; ++seed) {
      const Chain truth = arm_with_unknown_harmonic(seed, 4e-4);
      const Calibration c =
          calibrate_robot({test::nominal_robot(), {}, test::tracker, measured_again(truth, 25, 12, scatter, seed)}, {},
                          Rng(1))
              .value();
      ASSERT_TRUE(c.prediction);
      const FreshErrors fresh = fresh_errors(truth, c, 100 + seed);
      EXPECT_GT(c.after.position.holdout.mean, 0.5 * fresh.mean) << scatter << " rad, seed " << seed;
      EXPECT_LT(fresh.over_sd, 2.5) << scatter << " rad, seed " << seed;
      EXPECT_TRUE(c.estimate.outliers.empty()) << scatter << " rad, seed " << seed;
    }
}

TEST(RepeatedPoses, OfAnArmWithoutModelErrorTheyAverageTheNoise) {
  const Chain truth = arm_with_unknown_harmonic(1, 0.0);
  const auto sd_of = [&](int times) {
    const PoseSet set = measured_again(truth, 40, times, 1e-4, 1);
    const Calibration c = calibrate_robot({test::nominal_robot(), {}, test::tracker, set}, {}, Rng(1)).value();
    EXPECT_LT(fresh_errors(truth, c, 7).over_sd, 1.6) << times;
    return std::sqrt(c.estimate.covariance.diagonal().minCoeff());
  };
  EXPECT_LT(sd_of(16), 0.6 * sd_of(2));
}

TEST(RepeatedPoses, DifferentPosesOfASmallStageAreNoRepeats) {
  Chain stage;
  Joint joint;
  joint.name = "x";
  joint.type = JointType::prismatic;
  joint.link = UrdfLink{.axis = Vec3::UnitX()};
  stage.joints = {joint};
  PoseSet set;
  set.joint_names = {"x"};
  Rng rng(1);
  set.joints.resize(1, 30);
  for (int row = 0; row < 30; ++row) {
    set.joints(0, row) = 2e-4 * rng.uniform();
    set.line.push_back(row + 2);
    set.points.push_back({.row = row, .position = {set.joints(0, row), 1e-8 * rng.normal(), 1e-4}});
  }
  const auto calibration =
      calibrate_robot({.nominal = stage, .instrument = Instrument{.sigma = 1e-8}, .data = set}, {}, Rng(1));
  EXPECT_TRUE(calibration) << calibration.error().what;
}

}  // namespace
}  // namespace kinfer
