// SPDX-License-Identifier: Apache-2.0
// A tracker with accurate range and poor angles: what the full covariance of each point gains.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

constexpr double range_sd = 10e-6, angle_sd = 30e-6;  // [m], [rad]

/// Covariance of a point measured from the world's origin.
Mat3 covariance_seen(const Vec3& p) {
  const Vec3 along = p.normalized();
  const double across = angle_sd * p.norm();
  return range_sd * range_sd * along * along.transpose() +
         across * across * (Mat3::Identity() - along * along.transpose());
}

enum class Told { nothing, deviations, covariance };

PoseSet seen_by_tracker(const Chain& truth, int seed, Told told) {
  PoseSet data = measured(truth, paper2_poses(60, noise_free), seed);
  Rng rng(900 + seed);
  for (PointMeasurement& point : data.points) {
    const PrincipalDeviations spread = principal_deviations(covariance_seen(point.position));
    const Vec3 error = spread.axes * spread.sd.cwiseProduct(random_vector(rng));
    if (told == Told::covariance) point.sd = spread.sd, point.axes = spread.axes;
    if (told == Told::deviations) point.sd = covariance_seen(point.position).diagonal().cwiseSqrt();
    point.position += error;
  }
  return data;
}

/// Mean error on held-out poses [m], averaged over robots.
double unseen_error(Told told) {
  std::vector<double> errors;
  for (int seed = 1; seed <= 4; ++seed) {
    Chain nominal = nominal_robot();
    Chain truth = with_random_errors(nominal, {}, Rng(seed));
    truth.base = Frame::from_pose(Pose::from_xyz_rpy({2.4, -2.2, 0.35}, {0.02, -0.03, 2.3}));
    const PoseSet data = seen_by_tracker(truth, seed, told);
    const auto found = calibrate_robot({nominal, {}, std::nullopt, data}, {.model = FixedModel{}}, Rng(1)).value();
    EXPECT_EQ(found.usability, Usability::use) << words::verdict(found);
    errors.push_back(mean(point_errors(found.estimate.chain, measured(truth, paper2_poses(300, noise_free), 77))));
  }
  return mean(errors);
}

TEST(PointCovariance, HalvesTheErrorThatATrackerOfPoorAnglesLeaves) {
  const double full = unseen_error(Told::covariance);
  EXPECT_LT(full, 0.6 * unseen_error(Told::nothing));
  EXPECT_LT(full, 0.7 * unseen_error(Told::deviations)) << "the world's axes are not the tracker's";
}

}  // namespace
}  // namespace kinfer
