// SPDX-License-Identifier: Apache-2.0
// The small online parts of the filters: low pass, rest detection, bridged gaps, magnetic reference, gyro errors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/constants.hpp"
#include "kinfer/inertial/filters/kinfer_smoother.hpp"
#include "kinfer/inertial/filters/magnetic_reference.hpp"
#include "kinfer/inertial/filters/paper_ekf.hpp"
#include "kinfer/inertial/gap_bridging.hpp"
#include "kinfer/inertial/rest/low_pass.hpp"
#include "kinfer/inertial/rest/rest.hpp"
#include "kinfer/inertial/sensor_grading.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

TEST(LowPassOf, StartsAsTheMeanOfWhatItHasSeen) {
  LowPass<double> pass;
  double sum = 0.0;
  for (int k = 1; k <= 5; ++k) {
    pass.add(k * k, 0.01, 100.0);
    sum += k * k;
    EXPECT_NEAR(pass.value, sum / k, 1e-12);
  }
}

TEST(LowPassOf, ForgetsAStepWithItsTimeConstant) {
  LowPass<double> pass;
  constexpr double dt = 1e-3, tau = 0.5;
  for (int k = 0; k < 5000; ++k) pass.add(1.0, dt, tau);
  EXPECT_NEAR(pass.value, 1.0, 1e-12);
  for (int k = 0; k < 500; ++k) pass.add(0.0, dt, tau);
  EXPECT_NEAR(pass.value, std::exp(-1.0), 2e-3);
}

InsSample still_sample(const Vec3& rate = Vec3::Zero()) {
  InsSample sample;
  sample.has_acceleration = sample.has_angular_velocity = true;
  sample.acceleration = Vec3(0, 0, 9.81), sample.angular_velocity = rate;
  return sample;
}

RestDetector fed(const InsSample& sample, int rows, RestDetector detector = {}) {
  for (int k = 0; k < rows; ++k) detector.add(sample, 0.01, {});
  return detector;
}

TEST(RestDetectorOf, IsAtRestAfterAQuarterOfASecondOfStillness) {
  EXPECT_FALSE(fed(still_sample(), 20).at_rest({}));
  EXPECT_TRUE(fed(still_sample(), 30).at_rest({}));
  EXPECT_TRUE(fed(still_sample(Vec3(0.03, 0, 0)), 30).at_rest({})) << "a gyro bias is no motion";
  EXPECT_FALSE(fed(still_sample(Vec3(0.2, 0, 0)), 300).at_rest({})) << "a steady turn is no bias";
}

TEST(RestDetectorOf, EndsWithTheFirstMotionOrUnusableSample) {
  const RestDetector resting = fed(still_sample(), 100);
  EXPECT_FALSE(fed(still_sample(Vec3(0, 0.1, 0)), 10, resting).at_rest({}));
  InsSample missing = still_sample(), clipped = missing;
  missing.has_acceleration = false, clipped.angular_velocity_clipped = true;
  EXPECT_FALSE(fed(missing, 1, resting).at_rest({}));
  EXPECT_FALSE(fed(clipped, 1, resting).at_rest({}));
  InsSample knocked = still_sample();
  knocked.acceleration.x() = 3.0;
  EXPECT_FALSE(fed(knocked, 10, resting).at_rest({}));
}

TEST(RestBiasOf, IsTheMeanWeightedByDurationAndItsSpread) {
  RestPeriod brief, lasting;
  brief.begin = 0.0, brief.end = 1.0, brief.angular_velocity = Vec3(0.04, 0, 0);
  lasting.begin = 10.0, lasting.end = 13.0, lasting.angular_velocity = Vec3(0, 0, 0.08);
  const RestBias bias = bias_at_rest(std::vector{brief, lasting});
  EXPECT_LT((bias.mean - Vec3(0.01, 0, 0.06)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(bias.seconds, 4.0);
  EXPECT_NEAR(bias.spread.x(), std::sqrt(0.25 * 0.03 * 0.03 + 0.75 * 0.01 * 0.01), 1e-15);
  EXPECT_EQ(bias_at_rest(std::vector{brief}).spread, Vec3::Zero());
  EXPECT_EQ(bias_at_rest({}).seconds, 0.0);
}

/// Ten rows, 0.1 s apart, whose measurements are straight lines of time.
struct LineSensor {
  InsSensor sensor{.name = "imu", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  std::vector<double> time;

  LineSensor() {
    for (int row = 0; row < 10; ++row) {
      time.push_back(0.125 * row);
      for (std::size_t k = 0; k < 3; ++k) {
        sensor.acceleration.axis[k].push_back(static_cast<float>(row));
        sensor.angular_velocity.axis[k].push_back(static_cast<float>(-row));
      }
      sensor.faults.push_back(0);
    }
  }
  /// These rows lost: values spoiled and marked.
  LineSensor& lose(std::size_t from, std::size_t to, std::uint8_t fault) {
    for (std::size_t row = from; row < to; ++row) {
      sensor.faults[row] = fault;
      for (auto& axis : sensor.acceleration.axis) axis[row] = 1e6f;
      for (auto& axis : sensor.angular_velocity.axis) axis[row] = 1e6f;
    }
    return *this;
  }
};

TEST(BridgeGaps, OfAtMostTheGivenLengthByAStraightLine) {
  constexpr std::uint8_t both = acceleration_missing | angular_velocity_spike;
  const LineSensor gap = LineSensor().lose(3, 6, both);  // from row 2 to row 6: 0.5 s
  const InsSensor whole = bridge_gaps(gap.sensor, gap.time, 0.5), open = bridge_gaps(gap.sensor, gap.time, 0.49);
  for (std::size_t row = 3; row < 6; ++row) {
    EXPECT_EQ(whole.faults[row], 0);
    EXPECT_NEAR(whole.acceleration.axis[1][row], static_cast<double>(row), 1e-6);
    EXPECT_NEAR(whole.angular_velocity.axis[2][row], -static_cast<double>(row), 1e-6);
    EXPECT_EQ(open.faults[row], both);
    EXPECT_EQ(open.acceleration.axis[1][row], 1e6f);
  }
}

TEST(BridgeGaps, AtTheEndsAreLeftOpen) {
  const LineSensor begin = LineSensor().lose(0, 2, acceleration_missing),
                   end = LineSensor().lose(8, 10, acceleration_missing);
  EXPECT_EQ(bridge_gaps(begin.sensor, begin.time, 10.0).faults, begin.sensor.faults);
  EXPECT_EQ(bridge_gaps(end.sensor, end.time, 10.0).faults, end.sensor.faults);
}

TEST(BridgeGaps, AClippedForceIsReplacedAndAClippedRateIsNot) {
  const LineSensor force = LineSensor().lose(4, 5, acceleration_clipped),
                   rate = LineSensor().lose(4, 5, angular_velocity_clipped);
  EXPECT_EQ(bridge_gaps(force.sensor, force.time, 1.0).faults[4], 0);
  EXPECT_EQ(bridge_gaps(rate.sensor, rate.time, 1.0).faults[4], angular_velocity_clipped);
  EXPECT_EQ(bridge_gaps(rate.sensor, rate.time, 1.0).angular_velocity.axis[0][4], 1e6f);
}

/// Feeds a constant field of this strength while the sensor turns; the last answer.
double answer(MagneticReference& reference, double strength, double seconds, double turn_rate = 1.0) {
  double factor = -1.0;
  for (double t = 0.0; t < seconds; t += 0.05)
    factor = reference.noise_factor(strength * Vec3(0, 20, -44), turn_rate * 0.05, 0.05, {});
  return factor;
}

TEST(MagneticReferenceOf, UsesAConstantFieldFromTheStartAndLearnsIt) {
  MagneticReference reference;
  EXPECT_EQ(answer(reference, 1.0, 0.05), 1.0);
  EXPECT_FALSE(reference.learned);
  answer(reference, 1.0, 8.0);
  EXPECT_TRUE(reference.learned);
  EXPECT_NEAR(reference.reference.norm, std::hypot(20.0, 44.0), 1e-6);
  EXPECT_NEAR(reference.reference.dip, std::atan2(44.0, 20.0), 1e-6);
}

TEST(MagneticReferenceOf, LearnsNothingWithoutRotation) {
  MagneticReference reference;
  answer(reference, 1.0, 60.0, 0.0);
  EXPECT_FALSE(reference.learned) << "the field may move with the sensor";
}

TEST(MagneticReferenceOf, RejectsAnotherFieldForAMinuteAndTrustsItLessAfterwards) {
  MagneticReference reference;
  answer(reference, 1.0, 10.0);
  EXPECT_EQ(answer(reference, 1.3, 5.0, 0.0), 0.0);
  EXPECT_EQ(answer(reference, 1.3, 50.0, 0.0), 0.0);
  EXPECT_EQ(answer(reference, 1.3, 10.0, 0.0), MagneticOptions{}.rejection_factor);
  EXPECT_EQ(answer(reference, 1.0, 5.0, 0.0), 1.0) << "the known field is back";
}

TEST(MagneticReferenceOf, LearnsAFieldThatChangedForGood) {
  MagneticReference reference;
  answer(reference, 1.0, 10.0);
  EXPECT_EQ(answer(reference, 1.3, 15.0), 0.0);
  EXPECT_EQ(answer(reference, 1.3, 10.0), 1.0);
  EXPECT_EQ(answer(reference, 1.0, 2.0), 0.0);
}

TEST(MagneticReferenceOf, NoFieldIsNoMeasurement) {
  MagneticReference reference;
  EXPECT_EQ(reference.noise_factor(Vec3::Zero(), 0.1, 0.05, {}), 0.0);
  EXPECT_FALSE(reference.started);
}

TEST(Smoother, FindsTheBiasAndTheScaleOfTheGyro) {
  CarriedSensor c = carried({.seconds = 60.0, .has_magnetometer = false});
  const Vec3 bias(0.006, -0.005, 0.004);
  for (std::size_t k = 0; k < 3; ++k)
    for (float& w : c.sensor.angular_velocity.axis[k])
      w = static_cast<float>(static_cast<double>(w) / 1.003 + bias[static_cast<Eigen::Index>(k)]);
  const FilterOutput found = smooth_orientation(c.sensor, c.time);
  ASSERT_EQ(found.world_q_sensor.size(), c.time.size());
  ASSERT_EQ(found.bias.size(), found.bias_time.size());
  EXPECT_TRUE(std::is_sorted(found.bias_time.begin(), found.bias_time.end()));
  EXPECT_LT((found.bias[found.bias.size() / 2] - bias).norm(), 0.02 * degree);
  EXPECT_NEAR(found.scale.trace() / 3, 0.003, 0.0015) << "a prior of 0.002 pulls it towards zero";
}

struct Moments {
  double first = 0.0, second = 0.0;  ///< [rad/s]
};

/// Heading error of the smoother at the end of 30 s [rad]: a level carriage turns about the vertical from the first row
/// on, meanwhile twice for 0.7 s at small rates, and rests from `rest` on.
double heading_error_after(const Moments& moments, double bias, double rest) {
  constexpr double period = 0.01;
  std::vector<double> time, heading{0.0};
  InsSensor sensor{.name = "carriage", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  for (int k = 0; k < 3000; ++k) {
    const double t = period * k;
    const double rate = t > rest               ? 0.0
                        : t > 6.0 && t < 6.7   ? moments.first
                        : t > 15.0 && t < 15.7 ? moments.second
                                               : 0.3 * std::sin(0.8 * t + 0.5);
    time.push_back(t);
    if (k > 0) heading.push_back(heading.back() + rate * period);
    for (int i = 0; i < 3; ++i) {
      sensor.angular_velocity.axis[i].push_back(static_cast<float>(i == 2 ? rate + bias : 0.0));
      sensor.acceleration.axis[i].push_back(static_cast<float>(i == 2 ? standard_gravity : 0.0));
    }
  }
  sensor.faults.assign(time.size(), 0);
  const FilterOutput found = smooth_orientation(sensor, time);
  const Quat turned = found.world_q_sensor.front().conjugate() * found.world_q_sensor.back();
  return std::abs(wrap_to_pi(quat_log(turned).z() - heading.back()));
}

TEST(Smoother, AMomentOfSlowRotationIsNoBias) {
  EXPECT_LT(heading_error_after({0.042, 0.042}, 0.004, 28.0), 1.0 * degree);
}

TEST(Smoother, MomentsThatDifferAreNoBiasOfARecordingThatNeverRests) {
  for (const double rate : {0.005, 0.01, 0.02})
    EXPECT_LT(heading_error_after({rate, -rate}, 0.0, 40.0), 1.0 * degree) << rate;
}

TEST(Smoother, MomentsThatAgreeAreTheBiasOfARecordingWithoutRests) {
  for (const double bias : {0.005, 0.01, 0.02})
    EXPECT_LT(heading_error_after({0.0, 0.0}, bias, 40.0), 3.0 * degree) << bias;
}

TEST(PaperFilter, StartsWithTheFirstUsableSampleAndACopyGoesOnAlone) {
  const CarriedSensor c = carried({.seconds = 10.0});
  PaperEkf filter;
  EXPECT_FALSE(filter.started());
  filter.add({});
  EXPECT_FALSE(filter.started());
  for (std::size_t row = 0; row < 1000; ++row) filter.add(sample(c.sensor, c.time, row));
  EXPECT_TRUE(filter.started());
  PaperEkf copy = filter;
  for (std::size_t row = 1000; row < 1500; ++row) filter.add(sample(c.sensor, c.time, row));
  EXPECT_GT(filter.orientation().angularDistance(copy.orientation()), 0.1);
  for (std::size_t row = 1000; row < 1500; ++row) copy.add(sample(c.sensor, c.time, row));
  EXPECT_EQ(filter.orientation().coeffs(), copy.orientation().coeffs());
}

TEST(Statistics, OfASensorAreTheFiguresOfItsGrade) {
  const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c = carried({.seconds = 60.0, .rest = 15.0, .grade = &grade});
  const auto rests = rest_periods(c.sensor, c.time);
  const SensorStatistics found = sensor_statistics(c.sensor, c.time, rests);
  EXPECT_NEAR(found.rest_seconds, 29.0, 2.0);
  for (int k = 0; k < 3; ++k) {  // quantisation adds a little
    EXPECT_NEAR(found.rate_density[k] / grade.gyroscope.noise_density, 1.05, 0.15);
    EXPECT_NEAR(found.acceleration_density[k] / grade.accelerometer.noise_density, 1.05, 0.15);
  }
  EXPECT_NEAR(found.rate_resolution, grade.gyroscope.resolution, 1e-6);
  EXPECT_NEAR(found.field_resolution, grade.magnetometer.resolution, 1e-4);
  EXPECT_LT(found.gravity_error, 5 * grade.accelerometer.bias_sd);
  EXPECT_GT(found.largest_acceleration, 9.8);
  EXPECT_GT(found.largest_rate, 0.5);
}

}  // namespace
}  // namespace kinfer
