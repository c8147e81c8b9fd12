// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/diagnosis/section_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/inertial/diagnosis/attitude_columns.hpp"
#include "kinfer/inertial/diagnosis/repeated_rows.hpp"

namespace kinfer {
namespace {

void push(TriadColumns& triad, const Vec3& v) {
  for (std::size_t k = 0; k < 3; ++k) triad.axis[k].push_back(static_cast<float>(v[static_cast<Eigen::Index>(k)]));
}

/// A sensor that swings about an axis with a lever arm, at 100 Hz: closed form, with a little noise.
struct Swing {
  InsSensor sensor;
  std::vector<double> time;

  explicit Swing(double lag = 0.0, const Vec3& axis = Vec3(0.5, 0.8, 0.3).normalized()) {
    Rng rng(3);
    const Vec3 arm(0.4, -0.2, 0.7), gravity(0, 0, standard_gravity), field(18, 5, -45);
    const auto noise = [&](double sd) { return Vec3(sd * normal_vector(rng)); };
    for (int k = 0; k < 2400; ++k) {
      const double t = 0.01 * k;
      time.push_back(t);
      const auto angle = [](double s) { return 0.9 * std::sin(1.3 * s) + 0.3 * std::sin(3.1 * s); };
      const auto rate = [](double s) { return 1.17 * std::cos(1.3 * s) + 0.93 * std::cos(3.1 * s); };
      const auto acceleration = [](double s) { return -1.521 * std::sin(1.3 * s) - 2.883 * std::sin(3.1 * s); };
      const double late = t - lag;
      const Vec3 w = rate(late) * axis;
      const Mat3 r = exp_so3(angle(late) * axis);
      push(sensor.acceleration,
           r.transpose() * gravity + acceleration(late) * axis.cross(arm) + w.cross(w.cross(arm)) + noise(0.02));
      push(sensor.angular_velocity, rate(t) * axis + noise(1e-3));
      push(sensor.field, r.transpose() * field + noise(0.3));
    }
    sensor.faults.assign(time.size(), 0);
  }
};

std::size_t best_of(const MapLikelihoods& maps) {
  return static_cast<std::size_t>(std::ranges::max_element(maps.of) - maps.of.begin());
}

TEST(SectionFit, SoundInstrumentsFitBestAsTheyAre) {
  const Swing swing;
  const auto force = section_signals(swing.sensor.acceleration, swing.sensor.angular_velocity, swing.time, 0.1);
  const auto field = section_signals(swing.sensor.field, swing.sensor.angular_velocity, swing.time, 0.1);
  ASSERT_TRUE(force && field);
  const MapLikelihoods maps = map_likelihoods(*force, telling_sections(*force), 1.0, LeverArm::free);
  EXPECT_EQ(best_of(maps), 0U);
  EXPECT_EQ(best_of(map_likelihoods(*field, telling_sections(*field), 1.0, LeverArm::none)), 0U);
  EXPECT_GT(maps.of[0] - map_likelihoods(*force, telling_sections(*force), 0.0174533, LeverArm::free).of[0], 100.0)
      << "rad/s, not deg/s";
}

TEST(SectionFit, EveryPermutationOfTheRatesIsUndone) {
  const Swing swing;
  for (std::size_t m = 0; m < 48; m += 5) {
    const Mat3& axes = signed_permutations()[m];
    TriadColumns rates;
    for (std::size_t row = 0; row < swing.time.size(); ++row)
      push(rates, axes.transpose() * swing.sensor.angular_velocity.at(row));
    const auto signals = section_signals(swing.sensor.field, rates, swing.time, 0.1);
    EXPECT_EQ(best_of(map_likelihoods(*signals, telling_sections(*signals), 1.0, LeverArm::none)), m);
  }
}

TEST(SectionFit, ALagIsMeasured) {
  for (const double lag : {-0.05, 0.0, 0.033}) {
    const Swing swing(lag);
    const auto signals = section_signals(swing.sensor.acceleration, swing.sensor.angular_velocity, swing.time, 0.1);
    const InstrumentLag found = instrument_lag(*signals, Mat3::Identity());
    EXPECT_NEAR(found.lag, lag, 4e-3);  // samples are compared on a grid of 10 ms
    if (std::abs(lag) > 0.0) {
      EXPECT_GT(found.half_gain, 10.0);
      EXPECT_LT(found.rival_gain, 0.5 * found.gain);
    }
  }
}

TEST(SectionFit, ALagOfASensorThatOnlySlewsIsMeasuredByItsLeverArm) {
  const Swing swing(0.04, Vec3::UnitZ());
  const auto signals = section_signals(swing.sensor.acceleration, swing.sensor.angular_velocity, swing.time, 0.1);
  const InstrumentLag found = instrument_lag(*signals, Mat3::Identity());
  EXPECT_NEAR(found.lag, 0.04, 4e-3);
  EXPECT_LT(found.sd, 2e-3);
  EXPECT_GT(found.gain, 60.0);
}

/// A sensor at rest that an engine shakes, its rates and its forces in any phase to each other.
InsSensor shaken(std::vector<double>& time, double frequency, double phase) {
  InsSensor sensor;
  Rng rng(4);
  const Vec3 direction(1.2, -0.7, 1.5), axis(0.02, 0.01, -0.015);
  for (int k = 0; k < 6000; ++k) {
    time.push_back(0.005 * k);
    const double angle = 2.0 * std::numbers::pi * (frequency * time.back() + 0.2 * std::sin(0.3 * time.back()));
    push(sensor.acceleration, Vec3(1.0, 2.0, 9.5) + std::sin(angle) * direction + 8e-3 * normal_vector(rng));
    push(sensor.angular_velocity, std::sin(angle + phase) * axis + 1e-3 * normal_vector(rng));
  }
  return sensor;
}

TEST(SectionFit, TheVibrationOfASensorAtRestHasNoSingleLag) {
  for (const double phase : {0.3, 1.0, 2.0}) {
    std::vector<double> time;
    const InsSensor sensor = shaken(time, 23.0, phase);
    const auto signals = section_signals(sensor.acceleration, sensor.angular_velocity, time, 0.1);
    const InstrumentLag found = instrument_lag(*signals, Mat3::Identity());
    EXPECT_GT(found.rival_gain, 0.5 * found.gain) << phase;
  }
}

TEST(SectionFit, TooShortARecordingSaysNothing) {
  const Swing swing;
  const std::vector<double> second(swing.time.begin(), swing.time.begin() + 100);
  EXPECT_FALSE(section_signals(swing.sensor.acceleration, swing.sensor.angular_velocity, second, 0.1));
}

TEST(RepeatedRows, MeasuredRowsNeitherRepeatNorLieOnLines) {
  Swing swing;
  EXPECT_LT(sample_origin(swing.sensor.acceleration).repeated_share, 0.01);
  EXPECT_LT(sample_origin(swing.sensor.acceleration).interpolated_share, 0.01);
  for (auto& axis : swing.sensor.acceleration.axis)
    for (std::size_t k = 1; k + 1 < axis.size(); k += 2) axis[k] = axis[k - 1];
  const SampleOrigin held = sample_origin(swing.sensor.acceleration);
  EXPECT_NEAR(held.repeated_share, 0.5, 0.01);
  EXPECT_TRUE(held.repeated[7]);
  EXPECT_FALSE(held.repeated[8]);
}

TEST(RepeatedRows, ARestWithoutNoiseIsNoRepetition) {
  TriadColumns still;
  for (int k = 0; k < 500; ++k) push(still, k < 300 ? Vec3(0, 0, 9.8) : Vec3(0.01 * k, std::sin(0.3 * k), 9.8));
  EXPECT_LT(sample_origin(still).repeated_share, 0.02);
}

TEST(AttitudeColumns, EulerAnglesFollowTheVerticalAndRatesDoNot) {
  Swing swing;
  const auto rates = attitude_fit(swing.sensor);
  ASSERT_TRUE(rates);
  EXPECT_GT(rates->share_of_constant, 0.6);
  for (std::size_t row = 0; row < swing.time.size(); ++row) {
    const Vec3 up = swing.sensor.acceleration.at(row).normalized();
    const Vec3 rpy(std::atan2(up.y(), up.z()), -std::asin(up.x()), 1.0);
    for (std::size_t k = 0; k < 3; ++k)
      swing.sensor.angular_velocity.axis[k][row] = static_cast<float>(57.29578 * rpy[static_cast<Eigen::Index>(k)]);
  }
  const auto angles = attitude_fit(swing.sensor);
  EXPECT_LT(angles->error, 0.05);
  EXPECT_LT(angles->share_of_constant, 0.2);
}

TEST(AttitudeColumns, RatesOfALevelSensorThatTurnsAboutTheVerticalAreNoEulerAngles) {
  Swing swing(0.0, Vec3::UnitZ());
  const Vec3 tilt(0.004, -0.003, 0.0), bias(0.004, -0.003, 0.0);  // alike by chance
  for (std::size_t row = 0; row < swing.time.size(); ++row)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      swing.sensor.acceleration.axis[k][row] =
          static_cast<float>((exp_so3(-tilt) * Vec3(0.0, 0.0, standard_gravity))[axis]);
      swing.sensor.angular_velocity.axis[k][row] += static_cast<float>(bias[axis]);
    }
  const auto rates = attitude_fit(swing.sensor);
  EXPECT_LT(rates->error, 0.001);
  EXPECT_GT(rates->share_of_level, 0.9);
  EXPECT_GT(rates->share_of_constant, 0.9);
}

TEST(AttitudeColumns, EulerAnglesOfASensorThatDoesNotTiltPointUpAllTheSame) {
  Swing swing(0.0, Vec3::UnitZ());
  const Mat3 mounting = exp_so3(Vec3(0.8, 0.5, 0.0));  // the vertical in the sensor
  const Vec3 up = mounting * Vec3::UnitZ();
  for (std::size_t row = 0; row < swing.time.size(); ++row)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      swing.sensor.acceleration.axis[k][row] = static_cast<float>((mounting * swing.sensor.acceleration.at(row))[axis]);
      swing.sensor.angular_velocity.axis[k][row] =
          static_cast<float>(Vec3(std::atan2(up.y(), up.z()), -std::asin(up.x()), 0.1)[axis]);
    }
  const auto angles = attitude_fit(swing.sensor);
  EXPECT_LT(angles->share_of_level, 0.45) << "beside accelerations of 2 m/s²";
  EXPECT_GT(angles->share_of_constant, 0.6);
}

}  // namespace
}  // namespace kinfer
