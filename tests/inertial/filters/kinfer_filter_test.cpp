// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/kinfer_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/inertial/filters/orientation.hpp"
#include "support/carried_sensor.hpp"
#include "support/orientation_error.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;
using testing::orientation_error;

KinferErrorState unit(int state, double size) {
  KinferErrorState v = KinferErrorState::Zero();
  v[state] = size;
  return v;
}

TEST(KinferEstimate, DifferenceUndoesCorrection) {
  KinferEstimate estimate;
  estimate.world_q_sensor = quat_exp(Vec3(0.3, -0.4, 1.0));
  KinferErrorState error;
  for (int i = 0; i < kinfer_states; ++i) error[i] = 0.01 * (i + 1);
  EXPECT_LT((difference(corrected(estimate, error), estimate) - error).norm(), 1e-12);
}

/// Reference for predict()'s state at the end of a period: filters that start with another bias or scale.
TEST(KinferFilter, TransitionAgreesWithDifferences) {
  const CarriedSensor c = carried({.seconds = 8.0, .rest = 0.0, .has_magnetometer = false});
  const auto one_period = [&](const KinferErrorState& error, KinferTransition* transition) {
    KinferFilterOptions options{.update_period = 0.05};
    KinferFilter filter(options);
    const std::size_t first = 800;
    filter.add(sample(c.sensor, c.time, first));
    filter.set_estimate(corrected(filter.estimate(), error));
    std::size_t row = first + 1;
    while (!filter.update_is_due()) filter.integrate(sample(c.sensor, c.time, row++));
    const KinferTransition t = filter.predict();
    if (transition) *transition = t;
    return filter.estimate();
  };
  KinferTransition transition;
  const KinferEstimate nominal = one_period(KinferErrorState::Zero(), &transition);
  constexpr double h = 1e-5;
  for (int state = 0; state < 12; ++state) {
    const KinferErrorState change = difference(one_period(unit(5 + state, h), nullptr), nominal) / h;
    EXPECT_LT((change.head<3>() - transition.rotation_by_gyro_errors.col(state)).norm(), 2e-3 * 0.05)
        << "constant " << state;
  }
  for (int axis = 0; axis < 2; ++axis) {
    const KinferErrorState change = difference(one_period(unit(axis, h), nullptr), nominal) / h;
    EXPECT_NEAR(change[3], axis == 1 ? transition.velocity_by_tilt : 0.0, 1e-3);
    EXPECT_NEAR(change[4], axis == 0 ? -transition.velocity_by_tilt : 0.0, 1e-3);
    EXPECT_NEAR(change[axis], 1.0, 1e-6);
  }
}

TEST(KinferFilter, CovarianceByBlocksIsThatOfTheFullMatrices) {
  const CarriedSensor c = carried({.seconds = 8.0, .rest = 0.0});
  KinferFilter filter;
  for (std::size_t row = 0; row < c.time.size(); ++row) {
    filter.integrate(sample(c.sensor, c.time, row));
    if (!filter.update_is_due()) continue;
    const KinferCovariance before = filter.covariance();
    const KinferTransition t = filter.predict();
    KinferCovariance f = KinferCovariance::Identity();
    f.block<3, 12>(0, 5) = t.rotation_by_gyro_errors;
    f(3, 1) = t.velocity_by_tilt, f(4, 0) = -t.velocity_by_tilt;
    const KinferCovariance full = f * before * f.transpose() + KinferCovariance(t.noise.asDiagonal());
    ASSERT_LT((full - filter.covariance()).norm(), 1e-12 * full.norm()) << "row " << row;
    filter.correct();
  }
}

TEST(KinferFilter, GyroBiasIsFoundAtRestAndInMotion) {
  for (const double rest : {4.0, 0.0}) {
    CarriedSensor c = carried({.seconds = 60.0, .rest = rest, .has_magnetometer = false});
    const Vec3 bias(0.006, -0.005, 0.004);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (float& w : c.sensor.angular_velocity.axis[axis])
        w += static_cast<float>(bias[static_cast<Eigen::Index>(axis)]);
    KinferFilter filter;
    for (std::size_t row = 0; row < 55 * 200; ++row) filter.add(sample(c.sensor, c.time, row));
    EXPECT_LT((filter.estimate().bias - bias).norm(), (rest > 0 ? 0.01 : 0.1) * degree) << rest << " s of rest";
  }
}

/// Of a sensor that swings by 0.5 rad about the vertical at 40 Hz, whose samples are what they are said to be, or the
/// other: then half an interval is missing, 2.5° at the largest rate.
TEST(KinferFilter, RatesAreMeansOrThoseAtTheirTimes) {
  constexpr double dt = 0.025, pace = 7.0;  // [s], [rad/s]
  const auto angle = [](double t) { return t < 1.0 ? 0.0 : 0.5 * (1.0 - std::cos(pace * (t - 1.0))); };
  const auto rate = [](double t) { return t < 1.0 ? 0.0 : 0.5 * pace * std::sin(pace * (t - 1.0)); };
  for (const RateSample is : {RateSample::mean_since_previous, RateSample::at_its_time})
    for (const RateSample said : {RateSample::mean_since_previous, RateSample::at_its_time}) {
      KinferFilter filter({.magnetometer = MagnetometerUse::off, .rate_sample = said});
      double worst = 0.0;
      for (int i = 0; i < 400; ++i) {
        const double t = dt * i, w = is == RateSample::at_its_time ? rate(t) : (angle(t) - angle(t - dt)) / dt;
        filter.add({.time = t,
                    .acceleration = Vec3(0.0, 0.0, 9.81),
                    .angular_velocity = Vec3(0.0, 0.0, w),
                    .has_acceleration = true,
                    .has_angular_velocity = true});
        worst = std::max(worst, filter.orientation().angularDistance(Quat(Eigen::AngleAxisd(angle(t), Vec3::UnitZ()))));
      }
      if (is == said)
        EXPECT_LT(worst, 0.3 * degree);
      else
        EXPECT_NEAR(worst, 0.5 * dt * 0.5 * pace, 0.5 * degree);
    }
}

TEST(KinferFilter, ALargeMachineIsFollowedAsWellAsAHandHeldSensor) {
  const CarriedSensor hand = carried({.has_magnetometer = false});
  const CarriedSensor crane = carried({.seconds = 120.0, .reach = 8.0, .pace = 0.2, .has_magnetometer = false});
  for (const CarriedSensor* c : {&hand, &crane}) {
    const auto q = estimate_orientations(c->sensor, c->time, KinferFilterOptions{});
    EXPECT_LT(orientation_error(q, c->truth, std::vector<char>(q.size(), 1)).inclination, 0.5 * degree);
  }
}

TEST(KinferFilter, ASlowSteadyRotationIsNotTakenForABias) {
  CarriedSensor c = carried({.seconds = 60.0, .sampling_rate = 100.0, .rest = 1000.0, .has_magnetometer = false});
  const double angular_velocity = 1.0 * degree;  // about up, from 20 s to 28 s
  for (std::size_t row = 2000; row < 2800; ++row) {
    const Vec3 up = c.truth[row].conjugate() * Vec3::UnitZ();
    for (std::size_t axis = 0; axis < 3; ++axis)
      c.sensor.angular_velocity.axis[axis][row] += static_cast<float>(angular_velocity * up[axis]);
  }
  const auto q = estimate_orientations(c.sensor, c.time, KinferFilterOptions{});
  EXPECT_NEAR(q[1990].angularDistance(q[2790]), 8 * angular_velocity, 0.1 * angular_velocity * 8);
}

TEST(KinferFilter, AMagnetNearbyForTenSecondsDoesNotChangeTheHeading) {
  CarriedSensor c = carried({.seconds = 60.0});
  for (std::size_t row = 30 * 200; row < 40 * 200; ++row) {
    const Vec3 disturbance = c.truth[row].conjugate() * Vec3(25, 0, 10);
    for (std::size_t axis = 0; axis < 3; ++axis)
      c.sensor.field.axis[axis][row] += static_cast<float>(disturbance[axis]);
  }
  const auto q = estimate_orientations(c.sensor, c.time, KinferFilterOptions{});
  double worst = 0.0;
  for (std::size_t row = 30 * 200; row < 40 * 200; ++row) worst = std::max(worst, q[row].angularDistance(c.truth[row]));
  EXPECT_LT(worst, 2.5 * degree) << "the field was turned by 50 degrees";
}

TEST(KinferFilter, APermanentChangeOfTheFieldIsLearnedInMinutes) {
  CarriedSensor c = carried({.seconds = 240.0, .sampling_rate = 100.0, .rest = 2.0});
  const Vec3 now = 1.4 * (rot_z(0.5) * Vec3(0, 20.5, -44));
  for (std::size_t row = 60 * 100; row < c.time.size(); ++row) {
    const Vec3 field = c.truth[row].conjugate() * now;
    for (std::size_t axis = 0; axis < 3; ++axis) c.sensor.field.axis[axis][row] = static_cast<float>(field[axis]);
  }
  const auto q = estimate_orientations(c.sensor, c.time, KinferFilterOptions{});
  EXPECT_GT(q[230 * 100].angularDistance(c.truth[230 * 100]), 0.35) << "of the 0.5 rad that it changed by";
}

TEST(KinferFilter, ACopyContinuesFromTheStateOfTheOriginal) {
  const CarriedSensor c = carried({.seconds = 12.0});
  KinferFilter filter;
  for (std::size_t row = 0; row < 1000; ++row) filter.add(sample(c.sensor, c.time, row));
  KinferFilter copy = filter;
  for (std::size_t row = 1000; row < c.time.size(); ++row) {
    filter.add(sample(c.sensor, c.time, row));
    copy.add(sample(c.sensor, c.time, row));
  }
  EXPECT_TRUE(filter.orientation().coeffs() == copy.orientation().coeffs());
  EXPECT_LE(sizeof(KinferFilter), 4096u);
}

}  // namespace
}  // namespace kinfer
