// SPDX-License-Identifier: Apache-2.0
// With hardly more measurements than parameters, terms can explain an error that none of them has.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/deploy/predict.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// Positions of an arm whose second and third joints are off by up to
/// `size` [rad], as waves over two joints.
PoseSet bent_poses(const Chain& truth, double size, int poses, int seed) {
  PoseSet set = test::measured(truth, test::paper2_poses(poses, test::noise_free), seed);
  Rng rng(static_cast<std::uint64_t>(seed));
  for (PointMeasurement& point : set.points) {
    VectorXd q = set.joints.col(point.row);
    const VectorXd read = q;
    q[1] += size * std::sin(2.3 * read[1] + 1.1 * read[2]) * std::cos(read[0]);
    q[2] += size * std::cos(1.7 * read[0] + 0.3);
    point.position = forward(truth, q).position;
    for (double& x : point.position) x += test::tracker.sigma * rng.normal();
  }
  return set;
}

double rms_over_sd(const Calibration& c, const PoseSet& rows) {
  const auto poses = deploy::predict_poses(corrected_chain(c), rows).value();
  const auto spread = deploy::predict_uncertainties(corrected_chain(c), *c.prediction, rows).value();
  double sum = 0.0;
  for (const PointMeasurement& point : rows.points)
    sum += (point.position - poses[point.row].position)
               .cwiseAbs2()
               .cwiseQuotient(spread[point.row].position.diagonal())
               .sum();
  return std::sqrt(sum / (3.0 * static_cast<double>(rows.points.size())));
}

Calibration calibrated(int poses, double size, int seed) {
  const Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(static_cast<std::uint64_t>(seed)));
  return calibrate_robot({test::nominal_robot(), {}, test::tracker, bent_poses(truth, size, poses, seed)}, {}, Rng(1))
      .value();
}

TEST(FewPoses, AnErrorThatNoTermHasIsNotExplainedByThem) {
  for (int seed = 1; seed <= 8; ++seed) {
    const Calibration c = calibrated(12, 1.5e-3, seed);
    EXPECT_NE(c.usability, Usability::use) << seed;
    const Chain truth = with_random_errors(test::nominal_robot(), {}, Rng(static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(c.prediction);
    EXPECT_LT(rms_over_sd(c, bent_poses(truth, 1.5e-3, 200, 100 + seed)), 3.0) << seed;
  }
}

TEST(FewPoses, AnExactModelIsAsGoodAsItsInstrument) {
  for (int seed = 1; seed <= 4; ++seed) {
    const Calibration c = calibrated(14, 0.0, seed);
    EXPECT_EQ(c.usability, Usability::use) << seed;
    EXPECT_LT(c.estimate.sigma, 2.0 * test::tracker.sigma) << seed;
  }
}

}  // namespace
}  // namespace kinfer
