// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/segment_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/inertial/gaussian_smoothing.hpp"
#include "kinfer/inertial/headings.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedMotion;
using testing::CarriedSensor;

/// Two perfect sensors of one body, differently mounted, and the truth of each.
struct CarriedPair {
  InsRecording recording;
  std::vector<std::vector<Quat>> truth;
  CarriedMotion motion;

  explicit CarriedPair(bool has_magnetometer, double seconds = 20.0) {
    motion.seconds = seconds, motion.has_magnetometer = has_magnetometer;
    for (const Quat& mounting : {Quat::Identity(), Quat(from_rpy({1.0, -0.5, 2.0}))}) {
      motion.mounting = mounting;
      CarriedSensor c = carried(motion);
      c.sensor.name = truth.empty() ? "base" : "arm";
      recording.loggers = {{"log", c.time}};
      recording.sensors.push_back(c.sensor);
      truth.push_back(c.truth);
    }
  }
};

double worst_angle(const std::vector<Mat3>& found, const std::vector<Quat>& truth) {
  double worst = 0.0;
  for (std::size_t i = 200; i + 200 < found.size(); ++i)
    worst = std::max(worst, angle_between(found[i], truth[i].toRotationMatrix()));
  return worst;
}

TEST(SegmentMotionOf, ACarriedSensorIsItsCarriersMotion) {
  const CarriedPair pair(true);
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(segment_names(*found), (std::vector<std::string>{"base", "arm"}));
  EXPECT_NEAR(found->period, 0.005, 1e-12);
  EXPECT_EQ(found->rows(), pair.recording.loggers[0].time.size());
  EXPECT_NEAR(found->time[found->first_motion_row], 4.5, 0.6) << "it rests for four seconds, then starts gently";
  for (std::size_t s = 0; s < 2; ++s) {
    const SegmentMotion& segment = found->segments[s];
    EXPECT_FALSE(segment.still);
    EXPECT_LT(worst_angle(segment.rotation, pair.truth[s]), 2.0 * degree);
    for (std::size_t row = 1000; row < 3000; row += 271) {
      // A row's rate and force are those of the middle of the interval before it.
      const double t = found->time[row] - 0.0025, h = 2e-3;
      const Vec3 acceleration = (carrier_position(t + h, pair.motion) - 2 * carrier_position(t, pair.motion) +
                                 carrier_position(t - h, pair.motion)) /
                                (h * h);
      const Mat3 before = carrier_orientation(t - h, pair.motion).toRotationMatrix(),
                 after = carrier_orientation(t + h, pair.motion).toRotationMatrix();
      const Vec3 omega = log_so3(after * before.transpose()) / (2 * h);
      EXPECT_LT((segment.acceleration[row] - acceleration).norm(), 0.4) << "2 degrees of gravity";
      EXPECT_LT((segment.angular_velocity[row] - omega).norm(), 0.05);
    }
  }
}

TEST(SegmentMotionOf, SensorsOfOneBodyTurnAndAreTurnedAlike) {
  const auto found = segment_motion(CarriedPair(true).recording);
  ASSERT_TRUE(found);
  const SegmentMotion &a = found->segments[0], &b = found->segments[1];
  double rate = 0.0, change = 0.0;
  for (std::size_t row = 300; row + 300 < found->rows(); ++row) {
    rate = std::max(rate, (a.angular_velocity[row] - b.angular_velocity[row]).norm());
    change = std::max(change, (a.angular_acceleration[row] - b.angular_acceleration[row]).norm());
  }
  EXPECT_LT(rate, 0.05);
  EXPECT_LT(change, 0.2);
}

TEST(SegmentMotionOf, AngularAccelerationIsTheDerivativeOfTheAngularVelocity) {
  const auto found = segment_motion(CarriedPair(true).recording);
  ASSERT_TRUE(found);
  const SegmentMotion& segment = found->segments[0];
  for (std::size_t row = 1000; row < 3000; row += 97) {
    const Vec3 slope = (segment.angular_velocity[row + 1] - segment.angular_velocity[row - 1]) / (2 * found->period);
    EXPECT_LT((segment.angular_acceleration[row] - slope).norm(), 0.02);
  }
}

TEST(SegmentMotionOf, ASensorThatStandsStillIsMarkedAndDoesNotMove) {
  CarriedPair pair(true);
  InsSensor& still = pair.recording.sensors[0];
  const Vec3 gravity = still.acceleration.at(10), field = still.field.at(10);
  for (std::size_t k = 0; k < 3; ++k) {
    std::fill(still.angular_velocity.axis[k].begin(), still.angular_velocity.axis[k].end(), 0.0f);
    std::fill(still.acceleration.axis[k].begin(), still.acceleration.axis[k].end(), static_cast<float>(gravity[k]));
    std::fill(still.field.axis[k].begin(), still.field.axis[k].end(), static_cast<float>(field[k]));
  }
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->segments[0].still);
  EXPECT_FALSE(found->segments[1].still);
  EXPECT_EQ(found->segments[0].acceleration[2000], Vec3::Zero());
  EXPECT_EQ(found->segments[0].rotation[0], found->segments[0].rotation[3000]);
}

TEST(SegmentMotionOf, RowsNearAGapAndTheEndsAreNotUsable) {
  CarriedPair pair(true);
  for (std::size_t row = 2000; row < 2060; ++row)
    pair.recording.sensors[1].faults[row] = acceleration_missing;     // 0.3 s
  pair.recording.sensors[1].faults[1000] = angular_velocity_missing;  // a single row is bridged
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found);
  const int reach = gaussian_kernel(0.02, found->period).half;
  EXPECT_TRUE(found->usable[1000]);
  for (std::size_t row = 2005; row < 2055; ++row) EXPECT_FALSE(found->usable[row]) << row;
  EXPECT_FALSE(found->usable[0] || found->usable.back());
  EXPECT_TRUE(found->usable[static_cast<std::size_t>(reach)]);
  EXPECT_TRUE(found->usable[1500] && found->usable[2500]);
}

void lose(InsSensor& sensor, std::size_t begin, std::size_t end) {
  for (std::size_t row = begin; row < end; ++row) sensor.faults[row] = acceleration_missing | angular_velocity_missing;
}

TEST(SegmentMotionOf, AHeadingRestartsBehindAGapThatNoFilterBridges) {
  CarriedPair pair(true);
  lose(pair.recording.sensors[1], 1000, 1080);  // 0.4 s
  lose(pair.recording.sensors[1], 2000, 2300);
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->segments[0].restarts.empty());
  ASSERT_EQ(found->segments[1].restarts.size(), 1u);
  EXPECT_NEAR(found->segments[1].restarts[0], found->time[2150], 0.01);
}

TEST(SegmentMotionOf, BeforeItsFirstSampleAndAfterItsLastASensorDoesNotMove) {
  CarriedPair pair(true);
  lose(pair.recording.sensors[1], 0, 1500);
  lose(pair.recording.sensors[1], 2500, pair.recording.sensors[1].rows());
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found);
  const SegmentMotion& late = found->segments[1];
  EXPECT_TRUE(late.restarts.empty());
  for (const std::size_t row : {0u, 1000u, 1400u, 2600u, 3500u}) {
    EXPECT_EQ(late.angular_velocity[row], Vec3::Zero()) << row;
    EXPECT_EQ(late.acceleration[row], Vec3::Zero()) << row;
    EXPECT_FALSE(found->usable[row]) << row;
  }
  EXPECT_GT(late.angular_velocity[2000].norm(), 0.1);
}

TEST(SegmentMotionOf, SensorsThatNeverMeasureAtOneTimeAreNamed) {
  CarriedPair pair(true);
  lose(pair.recording.sensors[0], 2000, pair.recording.sensors[0].rows());
  lose(pair.recording.sensors[1], 0, 2200);
  EXPECT_EQ(segment_motion(pair.recording).error().what,
            "arm begins to measure at 11.00 s, after base ended at 10.00 s: all sensors must measure at the same time; "
            "--sensors names some of them");
}

TEST(SegmentMotionOf, TooFewSensorsRowsOrMeasurementsAreSaid) {
  CarriedPair pair(true);
  InsRecording one = pair.recording;
  one.sensors.resize(1);
  EXPECT_EQ(segment_motion(one).error().what, "identification needs at least two sensors, found 1");
  InsRecording brief = CarriedPair(true, 0.4).recording;
  EXPECT_EQ(segment_motion(brief).error().what, "identification needs at least 100 rows, found 80");
  InsRecording dead = pair.recording;
  std::fill(dead.sensors[1].faults.begin() + 50, dead.sensors[1].faults.end(), acceleration_missing);
  EXPECT_EQ(segment_motion(dead).error().what, "sensor arm has too few usable rates and specific forces");
}

TEST(SegmentMotionOf, RotationsByAnotherFilterAreOnTheSameClock) {
  const CarriedPair pair(true);
  const auto found = segment_motion(pair.recording);
  ASSERT_TRUE(found);
  const SegmentMotionOptions online{.filter = KinferFilterOptions{}};
  const auto rotations = segment_rotations(*found, pair.recording, pair.recording.sensors[1], online);
  ASSERT_EQ(rotations.size(), found->rows());
  EXPECT_LT(worst_angle(rotations, pair.truth[1]), 3.0 * degree);
}

TEST(GyroBasedMotion, HasTheHeadingOfTheMagnetometers) {
  const CarriedPair pair(true);
  EXPECT_TRUE(all_have_magnetometers(pair.recording));
  const auto found = gyro_based_motion(pair.recording);
  ASSERT_TRUE(found) << found.error().what;
  for (std::size_t s = 0; s < 2; ++s) EXPECT_LT(worst_angle(found->segments[s].rotation, pair.truth[s]), 2.5 * degree);
}

TEST(GyroBasedMotion, WithoutMagnetometersTheTiltIsRightAndTheHeadingArbitrary) {
  const CarriedPair pair(false);
  EXPECT_FALSE(all_have_magnetometers(pair.recording));
  const auto found = gyro_based_motion(pair.recording);
  ASSERT_TRUE(found);
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t row = 300; row < 3700; row += 100) {
      const Vec3 up = found->segments[s].rotation[row].row(2).transpose();  // the vertical in the sensor
      EXPECT_LT(angle_between(up, Vec3(pair.truth[s][row].conjugate() * Vec3::UnitZ())), 2.0 * degree) << row;
    }
}

TEST(GyroBasedMotion, BeforeAndBehindAGapTheHeadingIsThatOfTheFilterWithMagnetometer) {
  CarriedPair pair(true);
  lose(pair.recording.sensors[1], 1700, 2100);
  const auto found = gyro_based_motion(pair.recording), by_magnetometer = segment_motion(pair.recording);
  ASSERT_TRUE(found && by_magnetometer);
  for (const std::size_t row : {300u, 1500u, 2400u, 3000u})
    EXPECT_LT(angle_between(found->segments[1].rotation[row], by_magnetometer->segments[1].rotation[row]), 0.5 * degree)
        << row;
}

TEST(Heading, StepsBehindGapsAddUp) {
  const LinearHeading heading{.angle = 0.1, .steps = {{10.0, 0.5}, {20.0, -0.2}}};
  EXPECT_NEAR(heading.at(9.9), 0.1, 1e-15);
  EXPECT_NEAR(heading.at(10.0), 0.6, 1e-15);
  EXPECT_NEAR(heading.at(25.0), 0.4, 1e-15);
}

TEST(Heading, TurnsEverythingInTheWorldAboutTheVerticalAndNotTheGyro) {
  const LinearHeading heading{.angle = 0.3, .drift = 0.02, .middle = 50.0};
  EXPECT_NEAR(heading.at(50.0), 0.3, 1e-15);
  EXPECT_NEAR(heading.at(100.0), 1.3, 1e-15);
  SegmentMotion segment;
  segment.rotation = {rot_x(0.4), rot_x(0.4)};
  segment.gyro = segment.angular_velocity = segment.angular_acceleration =
      segment.acceleration = {Vec3(1, 2, 3), Vec3(1, 2, 3)};
  const std::vector<double> time{50.0, 100.0};
  turn(segment, time, heading);
  for (std::size_t i = 0; i < 2; ++i) {
    const Mat3 by = rot_z(heading.at(time[i]));
    EXPECT_LT((segment.rotation[i] - by * rot_x(0.4)).norm(), 1e-15);
    for (const auto* vectors : {&segment.angular_velocity, &segment.angular_acceleration, &segment.acceleration})
      EXPECT_LT(((*vectors)[i] - by * Vec3(1, 2, 3)).norm(), 1e-14);
    EXPECT_EQ(segment.gyro[i], Vec3(1, 2, 3));
  }
}

}  // namespace
}  // namespace kinfer
