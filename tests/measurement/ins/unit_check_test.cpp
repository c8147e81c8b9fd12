// SPDX-License-Identifier: Apache-2.0
// Single columns and their faults, units that a file gets wrong, and what one row of a sensor says.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "kinfer/measurement/ins/clock_correction.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "kinfer/measurement/ins/unit_check.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
constexpr std::array scales{2.0, 4.0, 8.0};

/// A slow wave with some noise: no value repeats.
std::vector<float> noisy_wave(double amplitude, std::size_t rows = 2000) {
  std::vector<float> column;
  Rng rng(2);
  for (std::size_t row = 0; row < rows; ++row)
    column.push_back(static_cast<float>(amplitude * std::sin(0.01 * static_cast<double>(row)) + 1e-3 * rng.normal()));
  return column;
}

std::vector<float> limited(std::vector<float> column, float range) {
  for (float& value : column) value = std::clamp(value, -range, range);
  return column;
}

long count_true(const std::vector<bool>& rows) {
  return std::count(rows.begin(), rows.end(), true);
}

TEST(ClippedRows, AreThoseAtTheEndOfTheRange) {
  const std::vector<float> wave = noisy_wave(5.0);
  for (const float range : {2.0f, 4.0f, 3.3f}) {  // a usual full scale, and an unusual one
    const std::vector<bool> clipped = find_clipped_rows(limited(wave, range), scales, 1.0);
    ASSERT_EQ(clipped.size(), wave.size()) << range;
    for (std::size_t row = 0; row < wave.size(); ++row) EXPECT_EQ(clipped[row], std::abs(wave[row]) >= range);
  }
}

TEST(ClippedRows, OrdinaryMotionAndSmallPeaksAreNotClipped) {
  EXPECT_EQ(count_true(find_clipped_rows(noisy_wave(5.0), scales, 1.0)), 0);
  EXPECT_EQ(count_true(find_clipped_rows(limited(noisy_wave(5.0), 2.0f), scales, 2.5)), 0);  // below the smallest range
  EXPECT_TRUE(find_clipped_rows({}, scales, 1.0).empty());
}

TEST(Spikes, OfOneToThreeRowsAreFound) {
  for (const std::size_t width : {1u, 2u, 3u}) {
    std::vector<float> column = noisy_wave(1.0);
    for (std::size_t row = 700; row < 700 + width; ++row) column[row] += 9.0f;
    const std::vector<bool> spikes = find_spikes(column, 0.5);
    EXPECT_EQ(count_true(spikes), static_cast<long>(width));
    for (std::size_t row = 700; row < 700 + width; ++row) EXPECT_TRUE(spikes[row]) << row;
  }
}

TEST(Spikes, StepsPlateausAndSmallDeviationsAreNone) {
  std::vector<float> step = noisy_wave(1.0), plateau = step, small = step;
  for (std::size_t row = 700; row < step.size(); ++row) step[row] += 9.0f;
  for (std::size_t row = 700; row < 704; ++row) plateau[row] += 9.0f;
  small[700] += 0.4f;
  for (const auto& column : {step, plateau, small}) EXPECT_EQ(count_true(find_spikes(column, 0.5)), 0);
  EXPECT_TRUE(find_spikes({1, 2, 3, 4}, 0.5).empty()) << "too few rows to tell";
  EXPECT_EQ(count_true(find_spikes(std::vector<float>(50, no_number), 0.5)), 0);
}

TEST(Spikes, AtEitherEndAreFound) {
  std::vector<float> column = noisy_wave(1.0);
  column.front() -= 5.0f, column.back() += 5.0f;
  const std::vector<bool> spikes = find_spikes(column, 0.5);
  EXPECT_EQ(count_true(spikes), 2);
  EXPECT_TRUE(spikes.front() && spikes.back());
}

void scale_all(TriadColumns& triad, float factor) {
  for (auto& axis : triad.axis)
    for (float& value : axis) value *= factor;
}

InsSensor plausible_sensor() {
  return testing::carried({.seconds = 12.0}).sensor;
}

TEST(UnitCheck, APlausibleSensorHasNoWarnings) {
  EXPECT_TRUE(check_units(plausible_sensor(), true).empty());
  EXPECT_TRUE(check_units(plausible_sensor(), false).empty());
}

TEST(UnitCheck, GravityInOtherUnitsIsFatalAndSaysWhatToWrite) {
  InsSensor in_g = plausible_sensor(), in_mg = in_g;
  scale_all(in_g.acceleration, static_cast<float>(1 / 9.80665)), scale_all(in_mg.acceleration, 101.97f);
  const auto warnings = check_units(in_g, true);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].fatal);
  EXPECT_NE(warnings[0].sentence.find("imu_ax[g]"), std::string::npos) << warnings[0].sentence;
  const auto others = check_units(in_mg, true);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_TRUE(others[0].fatal);
  EXPECT_NE(others[0].sentence.find("state the unit of imu_ax"), std::string::npos) << others[0].sentence;
}

TEST(UnitCheck, CentrifugalForceOnAWheelIsNoOtherUnit) {
  InsSensor wheel = plausible_sensor();
  for (std::size_t row = 0; row < wheel.rows(); ++row) {
    const bool rotates = row > wheel.rows() / 4;
    wheel.acceleration.axis[0][row] = rotates ? 24.0f : 0.1f;
    wheel.angular_velocity.axis[2][row] = rotates ? 12.0f : 0.01f;
  }
  EXPECT_TRUE(check_units(wheel, true).empty()) << "gravity is read at rest";
  wheel.angular_velocity.axis[2].assign(wheel.rows(), 12.0f);
  EXPECT_TRUE(check_units(wheel, true).empty()) << "it never rests, so nothing is known";
  scale_all(wheel.acceleration, 100.0f);
  EXPECT_EQ(check_units(wheel, true).size(), 1u) << "beyond any accelerometer on a wheel";
}

TEST(UnitCheck, AngularVelocityInDegreesIsFatalAndAFewCorruptRowsAreNot) {
  InsSensor sensor = plausible_sensor();
  sensor.angular_velocity.axis[0][100] = 1e9f;
  EXPECT_TRUE(check_units(sensor, true).empty());
  scale_all(sensor.angular_velocity, static_cast<float>(1 / degree));
  const auto warnings = check_units(sensor, true);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].fatal);
  EXPECT_NE(warnings[0].sentence.find("imu_gx[deg/s]"), std::string::npos) << warnings[0].sentence;
}

TEST(UnitCheck, AFieldThatExistsNowhereOnlyLosesTheMagnetometer) {
  InsSensor in_gauss = plausible_sensor(), dead = in_gauss;
  scale_all(in_gauss.field, 0.01f), scale_all(dead.field, 0.0f);
  ASSERT_EQ(check_units(in_gauss, false).size(), 1u);
  EXPECT_FALSE(check_units(in_gauss, false)[0].fatal);
  EXPECT_TRUE(check_units(in_gauss, true).empty()) << "the file states the unit";
  for (const bool has_unit : {false, true}) {
    ASSERT_EQ(check_units(dead, has_unit).size(), 1u);
    EXPECT_FALSE(check_units(dead, has_unit)[0].fatal);
  }
}

TEST(Sample, HoldsWhatItsRowsFaultsLeave) {
  InsSensor sensor = plausible_sensor();
  const std::vector<double> time(sensor.rows(), 7.0);
  const auto at = [&](unsigned faults) {
    sensor.faults[3] = static_cast<std::uint8_t>(faults);
    return sample(sensor, time, 3);
  };
  const InsSample sound = at(0);
  EXPECT_TRUE(sound.has_acceleration && sound.has_angular_velocity && sound.has_field &&
              !sound.angular_velocity_clipped);
  EXPECT_EQ(sound.acceleration, sensor.acceleration.at(3));
  EXPECT_EQ(sound.time, 7.0);
  for (const unsigned fault : {acceleration_missing, acceleration_clipped, acceleration_spike}) {
    EXPECT_FALSE(at(fault).has_acceleration);
    EXPECT_EQ(at(fault).acceleration, Vec3::Zero());
    EXPECT_TRUE(at(fault).has_angular_velocity && at(fault).has_field);
  }
  for (const unsigned fault : {angular_velocity_missing, angular_velocity_spike})
    EXPECT_FALSE(at(fault).has_angular_velocity);
  EXPECT_TRUE(at(angular_velocity_clipped).has_angular_velocity &&
              at(angular_velocity_clipped).angular_velocity_clipped);
  EXPECT_FALSE(at(angular_velocity_clipped | angular_velocity_missing).angular_velocity_clipped);
  EXPECT_FALSE(at(field_missing).has_field);
  EXPECT_EQ((at(acceleration_spike | field_missing), count(sensor, acceleration_spike)), 1u);
}

TEST(ClockCorrectionOf, ATimeIsOffsetPlusDriftFromTheMiddle) {
  const ClockCorrection correction{.offset = 0.25, .drift = 1e-3, .middle = 100.0};
  EXPECT_DOUBLE_EQ(correction.shift_at(100.0), 0.25);
  EXPECT_DOUBLE_EQ(correction.shift_at(300.0), 0.45);
  EXPECT_FALSE(correction.is_none());
  EXPECT_TRUE((ClockCorrection{.middle = 5.0}).is_none());
  EXPECT_FALSE((ClockCorrection{.drift = -1e-9}).is_none());
}

}  // namespace
}  // namespace kinfer
