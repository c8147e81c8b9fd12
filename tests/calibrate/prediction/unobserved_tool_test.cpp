// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/unobserved_tool.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// Components of the tool's rotation within 1.96 standard deviations, of robots whose tool is turned by its tolerance.
int rotations_inside(Measured measured, int robots, int unseen) {
  int inside = 0;
  for (int seed = 1; seed <= robots; ++seed) {
    const Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(seed));
    const PoseSet data = test::measured(truth, {.poses = 50, .instrument = test::tracker, .measured = measured}, seed);
    const Calibration c = calibrate_robot({test::nominal_robot(), {}, test::tracker, data}, {}, Rng(1)).value();
    const PoseSet rows = test::measured(truth, {.poses = unseen, .instrument = {}}, 100 + seed);
    const Chain chain = corrected_chain(c);
    const auto poses = deploy::predict_poses(chain, rows, c.prediction).value();
    const auto uncertainties = deploy::predict_uncertainties(chain, *c.prediction, rows).value();
    for (std::size_t row = 0; row < poses.size(); ++row) {
      const Mat3 right = forward(truth, rows.joints.col(static_cast<Eigen::Index>(row))).rotation;
      const Vec3 turn = log_so3(poses[row].rotation * right.transpose());
      for (int axis = 0; axis < 3; ++axis)
        inside += std::abs(turn[axis]) < 1.96 * std::sqrt(uncertainties[row].rotation(axis, axis));
      // What is measured is not widened: 10 µrad of noise leave no tenth of a degree.
      if (measured == Measured::poses) EXPECT_LT(std::sqrt(uncertainties[row].rotation.trace()), 0.1 * degree);
    }
  }
  return inside;
}

TEST(UnobservedTool, OrientationsFromPointsAloneAreAsUncertainAsTheToolsRotation) {
  constexpr int robots = 10, unseen = 20;
  EXPECT_GT(rotations_inside(Measured::positions, robots, unseen), 0.8 * robots * unseen * 3);
  EXPECT_GT(rotations_inside(Measured::poses, 2, unseen), 0.85 * 2 * unseen * 3);
}

}  // namespace
}  // namespace kinfer
