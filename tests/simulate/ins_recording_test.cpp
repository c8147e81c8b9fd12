// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/ins_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"

namespace kinfer {
namespace {

constexpr double g = 9.80665;  // [m/s²]

/// A machine of one stationary sensor, and its error-free samples over `rows` rows.
Machine one_sensor(std::size_t sensors = 1) {
  Machine machine;
  for (std::size_t s = 0; s < sensors; ++s)
    machine.sensors.push_back(
        {.name = "ins" + std::to_string(s), .segment = "", .joint = 0, .parent = -1, .segment_T_sensor = {}});
  return machine;
}

MachineMotion still(const Machine& machine, std::size_t rows, double sampling_rate = 200.0,
                    const Vec3& turning = Vec3::Zero()) {
  MachineMotion motion = make_motion(machine, rows, sampling_rate);
  for (SensorMotion& sensor : motion.sensors)
    for (std::size_t row = 0; row < rows; ++row) {
      sensor.force[row] = Vec3(0, 0, 9.81);
      sensor.angular_velocity[row] = turning;
      sensor.field[row] = magnetic_field_world;
    }
  return motion;
}

struct Moments {
  double mean = 0.0, sd = 0.0, lag_one = 0.0;  // lag_one: autocorrelation at one row
};

Moments moments(const std::vector<float>& values) {
  Moments m;
  const auto n = static_cast<double>(values.size());
  for (const float v : values) m.mean += v / n;
  double square = 0.0, product = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    square += (values[i] - m.mean) * (values[i] - m.mean);
    if (i > 0) product += (values[i] - m.mean) * (values[i - 1] - m.mean);
  }
  m.sd = std::sqrt(square / n);
  m.lag_one = product / square;
  return m;
}

SensorModel grade(const char* name) {
  return *sensor_grade(name);
}

TEST(InsSimulation, NoiseGradeIsWhiteWithTheDensityOfItsDataSheet) {
  constexpr std::size_t n = 40000;
  const Machine machine = one_sensor();
  const InsRecording recording = simulate_recording(machine, still(machine, n), grade("noise"), {}, Rng(1));
  const InsSensor& sensor = recording.sensors[0];
  const double bandwidth = std::sqrt(100.0);  // √Hz at 200 samples a second
  const std::pair<const TriadColumns*, double> instruments[] = {{&sensor.acceleration, 120e-6 * g * bandwidth},
                                                                {&sensor.angular_velocity, 0.007 * degree * bandwidth},
                                                                {&sensor.field, 0.02 * bandwidth}};
  const double spread = 5.0 / std::sqrt(2.0 * n);  // five sigma of a standard deviation
  for (const auto& [columns, sd] : instruments)
    for (const auto& axis : columns->axis) {
      const Moments seen = moments(axis);
      EXPECT_NEAR(seen.sd / sd, 1.0, spread);
      EXPECT_LT(std::abs(seen.lag_one), 5.0 / std::sqrt(n));
    }
  EXPECT_NEAR(moments(sensor.acceleration.axis[2]).mean, 9.81, 5.0 * 120e-6 * g * bandwidth / std::sqrt(n));
}

TEST(InsSimulation, IndustrialBiasesHaveTheStatedStandardDeviationAndDifferFromSensorToSensor) {
  constexpr std::size_t sensors = 300, rows = 40;
  const Machine machine = one_sensor(sensors);
  const InsRecording recording = simulate_recording(machine, still(machine, rows), grade("industrial"), {}, Rng(2));
  double square = 0.0;
  for (const InsSensor& sensor : recording.sensors)
    for (const auto& axis : sensor.angular_velocity.axis) square += std::pow(moments(axis).mean, 2) / (3.0 * sensors);
  const double bias = 0.2 * degree, noise = 0.007 * degree * 10.0 / std::sqrt(rows), drift = 10.0 / 3600 * degree;
  const double expected = std::sqrt(bias * bias + noise * noise + drift * drift);
  EXPECT_NEAR(std::sqrt(square) / expected, 1.0, 5.0 / std::sqrt(2.0 * 3.0 * sensors));
}

TEST(InsSimulation, GyroSaturatesAtItsRangeAndTheRowsAreMarked) {
  const Machine machine = one_sensor();
  SensorModel model = grade("noise");
  model.gyroscope.range = 250 * degree;
  const InsSensor sensor =
      simulate_recording(machine, still(machine, 100, 200.0, {5.0, 0.0, 0.0}), model, {}, Rng(1)).sensors[0];
  for (const float angular_velocity : sensor.angular_velocity.axis[0])
    EXPECT_FLOAT_EQ(angular_velocity, static_cast<float>(250 * degree));
  EXPECT_EQ(count(sensor, angular_velocity_clipped), 100u);
  EXPECT_EQ(count(sensor, acceleration_clipped), 0u);
}

TEST(InsSimulation, TheSpecifiedFractionOfRowsIsMissingInRunsOfFiveOnAverage) {
  constexpr std::size_t n = 100000;
  const Machine machine = one_sensor();
  const InsSensor sensor =
      simulate_recording(machine, still(machine, n), grade("noise"), {.missing = 0.1}, Rng(3)).sensors[0];
  std::size_t lost = 0, runs = 0;
  for (std::size_t row = 0; row < n; ++row) {
    const bool gone = std::isnan(sensor.angular_velocity.axis[1][row]);
    EXPECT_EQ(gone, (sensor.faults[row] & angular_velocity_missing) != 0);
    lost += gone;
    runs += gone && (row == 0 || !std::isnan(sensor.angular_velocity.axis[1][row - 1]));
  }
  const double fraction = static_cast<double>(lost) / n, length = static_cast<double>(lost) / static_cast<double>(runs);
  EXPECT_NEAR(fraction, 0.1,
              5.0 * std::sqrt(0.1 * 0.9 * 9.0 / n));  // rows are missing in runs: variance factor 2 · 5 − 1 = 9
  EXPECT_NEAR(length, 5.0, 5.0 * std::sqrt(20.0 / static_cast<double>(runs)));  // geometric: variance 5² − 5
}

TEST(InsSimulation, SpikesOccurAtTheSpecifiedRate) {
  constexpr std::size_t n = 120000;  // ten minutes
  const Machine machine = one_sensor();
  const InsSensor sensor =
      simulate_recording(machine, still(machine, n), grade("noise"), {.spikes = 12}, Rng(4)).sensors[0];
  for (const auto& axis : sensor.acceleration.axis) {
    std::size_t wild = 0;
    const double middle = moments(axis).mean;
    for (const float v : axis) wild += std::abs(v - middle) > 10.0;
    EXPECT_NEAR(static_cast<double>(wild), 120.0, 5.0 * std::sqrt(120.0));
  }
}

TEST(InsSimulation, SteelDisturbsTheFieldSmoothlyByTheSpecifiedRms) {
  constexpr std::size_t n = 400000;  // 2000 s: 500 correlation times of 2 · 2 s
  const Machine machine = one_sensor();
  SensorModel perfect;
  const InsSensor sensor =
      simulate_recording(machine, still(machine, n), perfect, {.magnetic_disturbance = 6.0}, Rng(5)).sensors[0];
  for (const auto& axis : sensor.field.axis) {
    const Moments seen = moments(axis);
    EXPECT_NEAR(seen.sd / 6.0, 1.0, 5.0 / std::sqrt(2.0 * 500));
    EXPECT_GT(seen.lag_one, 0.99999);
  }
}

TEST(InsSimulation, APerfectSensorMeasuresTheTruthAndOneWithoutMagnetometerNoField) {
  const Machine machine = one_sensor();
  const MachineMotion motion = still(machine, 10, 200.0, {0.1, -0.2, 0.3});
  const InsSensor sensor = simulate_recording(machine, motion, {}, {.has_magnetometer = false}, Rng(6)).sensors[0];
  EXPECT_FALSE(sensor.has_magnetometer());
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_EQ(sensor.acceleration.at(row), motion.sensors[0].force[row].cast<float>().cast<double>());
    EXPECT_EQ(sensor.angular_velocity.at(row), motion.sensors[0].angular_velocity[row].cast<float>().cast<double>());
  }
}

TEST(InsSimulation, SameSeedGivesTheSameBitsAndAnotherSeedDoesNot) {
  const Machine machine = one_sensor(2);
  const MachineMotion motion = still(machine, 500);
  const SensorFaults trouble{.spikes = 60.0, .magnetic_disturbance = 3.0};
  const auto once = simulate_recording(machine, motion, grade("consumer"), trouble, Rng(7));
  const auto again = simulate_recording(machine, motion, grade("consumer"), trouble, Rng(7));
  const auto other = simulate_recording(machine, motion, grade("consumer"), trouble, Rng(8));
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(once.sensors[s].acceleration.axis, again.sensors[s].acceleration.axis);
    EXPECT_EQ(once.sensors[s].field.axis, again.sensors[s].field.axis);
    EXPECT_NE(once.sensors[s].angular_velocity.axis, other.sensors[s].angular_velocity.axis);
  }
  EXPECT_NE(once.sensors[0].angular_velocity.axis, once.sensors[1].angular_velocity.axis);
}

TEST(InsSimulation, AnotherDriveHasTheSensorsBiasesAndOtherNoise) {
  constexpr std::size_t sensors = 100, rows = 2000;
  const Machine machine = one_sensor(sensors);
  const MachineMotion motion = still(machine, rows);
  const auto drive = [&](std::uint64_t number) {
    return simulate_recording(machine, motion, grade("industrial"), {}, Rng(2), number);
  };
  const InsRecording first = drive(1), second = drive(2),
                     unnumbered = simulate_recording(machine, motion, grade("industrial"), {}, Rng(2));
  double change = 0.0, correlation = 0.0;
  for (std::size_t s = 0; s < sensors; ++s) {
    EXPECT_EQ(first.sensors[s].angular_velocity.axis, unnumbered.sensors[s].angular_velocity.axis);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = first.sensors[s].angular_velocity.axis[k], &b = second.sensors[s].angular_velocity.axis[k];
      const Moments of_a = moments(a), of_b = moments(b);
      change += square(of_b.mean - of_a.mean) / (3.0 * sensors);
      for (std::size_t row = 0; row < rows; ++row)
        correlation += (a[row] - of_a.mean) * (b[row] - of_b.mean) / (of_a.sd * of_b.sd * 3.0 * sensors * rows);
    }
  }
  const double noise = 0.007 * degree * 10.0 / std::sqrt(rows), drift = 10.0 / 3600 * degree;
  const double expected = std::sqrt(2.0 * (noise * noise + drift * drift));
  EXPECT_NEAR(std::sqrt(change) / expected, 1.0, 5.0 / std::sqrt(2.0 * 3.0 * sensors));
  EXPECT_LT(std::abs(correlation), 5.0 / std::sqrt(3.0 * sensors * rows));
}

}  // namespace
}  // namespace kinfer
