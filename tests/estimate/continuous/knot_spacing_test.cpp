// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/knot_spacing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random.hpp"

namespace kinfer {
namespace {

/// One sensor whose every axis oscillates with these waves, plus noise.
struct Swing {
  std::vector<std::pair<double, double>> waves;  ///< [Hz], and the force's amplitude [m/s²]
  double sampling_rate = 200.0;                  ///< [Hz] of rows
  double duration = 30.0;                        ///< [s]
  double moving_from = 0.0;                      ///< [s]
  double spikes = 0.0;                           ///< a second
  double missing = 0.0;                          ///< of the rows
  double spike_size = 50.0;                      ///< [m/s²]; below 30 they are not flagged
};

InsRecording recorded(const Swing& swing) {
  constexpr double rate_noise = 1e-3, force_noise = 0.01;
  InsRecording recording;
  recording.loggers = {{.name = "log", .time = {}}};
  recording.sensors = {{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}}};
  InsSensor& sensor = recording.sensors[0];
  Rng rng(1);
  for (int row = 0; row < static_cast<int>(swing.duration * swing.sampling_rate); ++row) {
    const double t = row / swing.sampling_rate;
    double force = 0.0;
    for (const auto& [frequency, amplitude] : swing.waves)
      if (t >= swing.moving_from) force += amplitude * std::sin(2.0 * std::numbers::pi * frequency * t);
    const Vec3 force_error = force_noise * test::random_vector(rng), rate_error = rate_noise * test::random_vector(rng);
    const double spike = rng.uniform() * swing.sampling_rate < swing.spikes ? swing.spike_size : 0.0;
    const bool is_missing = rng.uniform() < swing.missing;
    recording.loggers[0].time.push_back(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      sensor.acceleration.axis[k].push_back(static_cast<float>(force + force_error[axis] + spike));
      sensor.angular_velocity.axis[k].push_back(static_cast<float>(0.1 * force + rate_error[axis]));
    }
    sensor.faults.push_back(is_missing     ? acceleration_missing | angular_velocity_missing
                            : spike > 30.0 ? acceleration_spike
                                           : 0);
  }
  return recording;
}

double knots(const Swing& swing) {
  return select_knot_spacing(recorded(swing));
}

TEST(KnotSpacing, SpikesTooSmallToBeFlaggedAreNoMotion) {
  EXPECT_DOUBLE_EQ(knots({.waves = {{0.6, 3.0}}, .spikes = 0.5, .spike_size = 20.0}), widest_knot_spacing);
}

TEST(KnotSpacing, IsWidestForAMachineAndFinerForAQuickerArm) {
  EXPECT_DOUBLE_EQ(knots({.waves = {{0.6, 3.0}}}), widest_knot_spacing);
  EXPECT_NEAR(knots({.waves = {{2.5, 3.0}}}), 0.05, 1e-6);
  EXPECT_NEAR(knots({.waves = {{5.0, 3.0}}}), 0.03, 1e-6);  // six samples
  EXPECT_DOUBLE_EQ(knots({.waves = {}}), widest_knot_spacing);
}

TEST(KnotSpacing, IsNeverFinerThanTheSamplesSupport) {
  for (const double sampling_rate : {25.0, 40.0, 50.0})
    EXPECT_DOUBLE_EQ(knots({.waves = {{3.0, 3.0}}, .sampling_rate = sampling_rate}), widest_knot_spacing);
  EXPECT_NEAR(knots({.waves = {{3.0, 3.0}}, .sampling_rate = 100.0}), 0.06, 1e-6);
  EXPECT_GE(knots({.waves = {{20.0, 3.0}}}), 0.025);
}

TEST(KnotSpacing, IsThatOfTheSlowestLogger) {
  InsRecording both = recorded({.waves = {{5.0, 3.0}}});
  const InsRecording slow = recorded({.waves = {{5.0, 3.0}}, .sampling_rate = 100.0});
  both.loggers.push_back(slow.loggers[0]);
  both.sensors.push_back(slow.sensors[0]);
  both.sensors.back().logger = 1;
  EXPECT_NEAR(select_knot_spacing(both), 6.0 / 100.0, 1e-6);
  std::swap(both.sensors[0], both.sensors[1]);
  EXPECT_NEAR(select_knot_spacing(both), 6.0 / 100.0, 1e-6);
}

TEST(KnotSpacing, VibrationAboveTheFinestKnotsIsNoiseAndRefinesNothing) {
  EXPECT_DOUBLE_EQ(knots({.waves = {{0.6, 3.0}, {31.0, 0.5}}}), widest_knot_spacing);
}

TEST(KnotSpacing, IsWiderForASlowMachineThatVibrates) {
  const auto spacing = [](const Swing& swing) {
    SensorModel grade;
    grade.name = "data sheet";
    grade.gyroscope.noise_density = 1e-4, grade.accelerometer.noise_density = 1e-3;  // as recorded() makes it
    return select_knot_spacing(recorded(swing), grade);
  };
  EXPECT_GT(spacing({.waves = {{0.1, 3.0}, {31.0, 0.5}}}), 2.0 * widest_knot_spacing);
  EXPECT_DOUBLE_EQ(spacing({.waves = {{0.1, 3.0}}}), widest_knot_spacing);
  EXPECT_LT(spacing({.waves = {{2.5, 3.0}, {31.0, 0.1}}}), widest_knot_spacing);
}

TEST(KnotSpacing, SpikesAndMissingRowsHaveNoInfluence) {
  EXPECT_DOUBLE_EQ(knots({.waves = {{0.6, 3.0}}, .spikes = 0.1, .missing = 0.1}), widest_knot_spacing);
  EXPECT_NEAR(knots({.waves = {{2.5, 3.0}}, .spikes = 0.1, .missing = 0.1}), 0.05, 1e-6);
}

TEST(KnotSpacing, AFastMinuteInALongSlowRecordingDecides) {
  EXPECT_NEAR(knots({.waves = {{2.5, 3.0}}, .sampling_rate = 100.0, .duration = 900.0, .moving_from = 840.0}), 0.06,
              1e-6);
}

TEST(KnotSpacing, IsWidestForTooShortARecording) {
  EXPECT_DOUBLE_EQ(knots({.waves = {{3.0, 3.0}}, .duration = 2.0}), widest_knot_spacing);
}

}  // namespace
}  // namespace kinfer
