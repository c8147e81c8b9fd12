// SPDX-License-Identifier: Apache-2.0
// Predictions outside the region that was measured: what holds there, and what their standard deviations have room for.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// The robot with its joints' ranges cut to this part about their middles.
Chain with_ranges(Chain chain, double part) {
  for (Joint& joint : chain.joints) {
    const double middle = 0.5 * (joint.lower + joint.upper), half = 0.5 * part * (joint.upper - joint.lower);
    joint.lower = middle - half, joint.upper = middle + half;
  }
  return chain;
}

enum class Effect { gains, backlash };

Chain true_robot(Effect effect, int seed) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(seed));
  Rng draws = Rng(50 + seed);
  for (Joint& joint : truth.joints)
    if (effect == Effect::gains)
      joint.gain = 1.0 + 1e-3 * draws.normal();
    else
      joint.backlash = 2e-4 * (1.0 + draws.uniform());
  return truth;
}

/// Points of random poses, approached from where the row before was.
PoseSet approached_points(const Chain& truth, double part, int poses, int seed) {
  const PoseSet drawn = test::measured(with_ranges(truth, part), {.poses = poses, .instrument = {}}, seed);
  PoseSet data = with_approach(drawn);
  const std::vector<Pose> tools = predicted_poses(truth, std::nullopt, data);
  Rng noise(1000 + seed);
  for (PointMeasurement& point : data.points) {
    point.position = tools[static_cast<std::size_t>(point.row)].position;
    for (double& coordinate : point.position) coordinate += test::tracker.sigma * noise.normal();
  }
  return data;
}

struct Outside {
  int inside = 0, all = 0;
  double squares = 0.0;  ///< [m²]
};

/// Coordinates of the tool point over the whole joint space within 1.96 standard deviations.
Outside predictions_outside(Effect effect, int seed) {
  const Chain truth = true_robot(effect, seed);
  const Instrument instrument{.sigma = test::tracker.sigma};
  const auto c =
      calibrate_robot({test::nominal_robot(), {}, instrument, approached_points(truth, 0.3, 100, seed)}, {}, Rng(1));
  Outside found;
  if (!c || !c->prediction) return found;
  const PoseSet rows = approached_points(truth, 1.0, 100, 100 + seed);
  const std::vector<Pose> right = predicted_poses(truth, std::nullopt, rows);
  const Chain chain = corrected_chain(*c);
  const auto poses = deploy::predict_poses(chain, rows, c->prediction).value();
  const auto uncertainties = deploy::predict_uncertainties(chain, *c->prediction, rows).value();
  for (std::size_t row = 0; row < poses.size(); ++row) {
    const Vec3 error = poses[row].position - right[row].position;
    const Vec3 sd = uncertainties[row].position.diagonal().cwiseSqrt();
    for (int axis = 0; axis < 3; ++axis) found.inside += std::abs(error[axis]) < 1.96 * sd[axis], ++found.all;
    found.squares += error.squaredNorm();
  }
  return found;
}

TEST(OutsideRegion, GainsAndBacklashHoldThereAndSoDoTheStandardDeviations) {
  for (const Effect effect : {Effect::gains, Effect::backlash}) {
    Outside all;
    for (int seed = 1; seed <= 4; ++seed) {
      const Outside one = predictions_outside(effect, seed);
      ASSERT_GT(one.all, 0);
      all.inside += one.inside, all.all += one.all, all.squares += one.squares;
    }
    EXPECT_GT(static_cast<double>(all.inside) / all.all, 0.88) << (effect == Effect::gains ? "gains" : "backlash");
    EXPECT_LT(std::sqrt(3.0 * all.squares / all.all), 0.4e-3) << (effect == Effect::gains ? "gains" : "backlash");
  }
}

TEST(OutsideRegion, StandardDeviationsHaveRoomForCorrectionsThatGoOnWhereTheyFade) {
  Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(5));
  for (Joint& joint : truth.joints) joint.harmonics = {{1.0, 3e-4, 0.0}, {2.0, 0.0, 2e-4}};
  const PoseSet data = test::measured(with_ranges(truth, 0.5), {.poses = 200, .instrument = test::tracker}, 5);
  const Calibration c = calibrate_robot({test::nominal_robot(), {}, test::tracker, data}, {}, Rng(1)).value();
  ASSERT_GT(c.prediction->beyond.size(), 0) << selected_model(c.model_selection);
  const Chain chain = corrected_chain(c);
  const PoseSet rows = test::measured(truth, {.poses = 50, .instrument = {}}, 6);
  const auto faded = deploy::predict_poses(chain, rows, c.prediction).value();
  const auto uncertainties = deploy::predict_uncertainties(chain, *c.prediction, rows).value();
  for (std::size_t row = 0; row < faded.size(); ++row) {
    const Vec3 shift = faded[row].position - forward(chain, rows.joints.col(static_cast<Eigen::Index>(row))).position;
    EXPECT_LE(shift.dot(Vec3(solve_spd(MatrixXd(uncertainties[row].position), VectorXd(shift)).value())), 1.0) << row;
  }
}

}  // namespace
}  // namespace kinfer
