// SPDX-License-Identifier: Apache-2.0
// Sensor failures: the filters return finite orientations and recover where possible.
#include <gtest/gtest.h>

#include <limits>

#include "kinfer/inertial/filters/kinfer_filter.hpp"
#include "kinfer/inertial/filters/orientation.hpp"
#include "support/carried_sensor.hpp"
#include "support/orientation_error.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;
using testing::HeadingOffset;
using testing::orientation_error;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

void set(TriadColumns& triad, std::size_t from, std::size_t to, const Vec3& value) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t row = from; row < to; ++row) triad.axis[axis][row] = static_cast<float>(value[axis]);
}

void expect_unit_quaternions(CarriedSensor c, const char* what) {
  flag_faults(c.sensor);
  for (const OrientationFilter& filter : orientation_filters())
    for (const Quat& q : estimate_orientations(c.sensor, c.time, filter.default_options))
      ASSERT_NEAR(q.norm(), 1.0, 1e-9) << filter.name << " with " << what;
}

TEST(BadInput, NoFailureMakesAFilterReturnNan) {
  const CarriedSensor good = carried({.seconds = 12.0, .sampling_rate = 100.0, .rest = 2.0});
  const std::size_t n = good.time.size(), middle = n / 2;
  const Vec3 gone = Vec3::Constant(std::nan(""));
  const auto broken = [&](const char* what, const auto& change) {
    CarriedSensor c = good;
    change(c);
    expect_unit_quaternions(c, what);
  };
  broken("a sensor dead from the middle on", [&](CarriedSensor& c) {
    for (TriadColumns* t : {&c.sensor.acceleration, &c.sensor.angular_velocity, &c.sensor.field})
      set(*t, middle, n, gone);
  });
  broken("zeros from the middle on", [&](CarriedSensor& c) {
    for (TriadColumns* t : {&c.sensor.acceleration, &c.sensor.angular_velocity, &c.sensor.field})
      set(*t, middle, n, Vec3::Zero());
  });
  broken("no specific force at all", [&](CarriedSensor& c) { set(c.sensor.acceleration, 0, n, gone); });
  broken("no rate at all", [&](CarriedSensor& c) { set(c.sensor.angular_velocity, 0, n, gone); });
  broken("an all-zero magnetometer", [&](CarriedSensor& c) { set(c.sensor.field, 0, n, Vec3::Zero()); });
  broken("huge numbers",
         [&](CarriedSensor& c) { set(c.sensor.angular_velocity, middle, middle + 50, Vec3::Constant(3e30)); });
  broken("huge forces",
         [&](CarriedSensor& c) { set(c.sensor.acceleration, middle, middle + 50, Vec3::Constant(-3e30)); });
  broken("huge fields", [&](CarriedSensor& c) { set(c.sensor.field, middle, middle + 50, Vec3::Constant(1e30)); });
  broken("a gap of an hour", [&](CarriedSensor& c) {
    for (std::size_t row = middle; row < n; ++row) c.time[row] += 3600.0;
  });
  broken("a saturated gyro", [&](CarriedSensor& c) {
    for (auto& axis : c.sensor.angular_velocity.axis)
      for (float& w : axis) w = std::clamp(w, -0.8f, 0.8f);
  });
  broken("free fall", [&](CarriedSensor& c) { set(c.sensor.acceleration, middle, n, Vec3::Constant(1e-30)); });
}

/// Sampled slowly, while it turns at a steady rate; rates are missing in two rows of ten, and the next row comes a
/// little early, so that this is no gap yet (three intervals).
double heading_error_without_some_rates(double period) {
  constexpr double rate = 0.5;  // [rad/s]
  KinferFilter filter;
  double turned = 0.0;
  for (int k = 0; k < 100; ++k) {
    InsSample sample;
    sample.time = period * (k % 10 == 2 ? k - 0.1 : k);
    sample.acceleration = Vec3(0.0, 0.0, 9.81);
    sample.has_acceleration = true;
    sample.has_angular_velocity = k < 2 || k % 10 > 1;
    if (sample.has_angular_velocity) sample.angular_velocity = Vec3(0.0, 0.0, rate), turned = rate * sample.time;
    filter.add(sample);
  }
  return filter.orientation().angularDistance(quat_exp(Vec3(0.0, 0.0, turned)));
}

/// Rows without a rate counted as rows with the rate zero, and an update of no time made everything NaN.
TEST(BadInput, MissingRatesOfSlowSamplingAreNoRatesOfZero) {
  for (const double period : {0.02, 0.04, 0.05, 0.07, 0.1, 0.12, 0.2}) {
    const double error = heading_error_without_some_rates(period);
    EXPECT_LT(error, 0.05) << period;  // nan is not less
  }
}

TEST(BadInput, NoRowsAndOneRowAreHandled) {
  CarriedSensor c = carried({.seconds = 12.0, .sampling_rate = 100.0});
  for (const std::size_t rows : {0, 1, 2}) {
    CarriedSensor few = c;
    few.time.resize(rows);
    for (TriadColumns* t : {&few.sensor.acceleration, &few.sensor.angular_velocity, &few.sensor.field})
      for (auto& axis : t->axis) axis.resize(rows);
    flag_faults(few.sensor);
    for (const OrientationFilter& filter : orientation_filters()) {
      const auto q = estimate_orientations(few.sensor, few.time, filter.default_options);
      ASSERT_EQ(q.size(), rows);
      if (rows == 0) continue;
      EXPECT_LT(q[0].angularDistance(c.truth[0]), 0.5 * degree) << filter.name;
    }
  }
}

TEST(BadInput, AGapInMotionIsRecoveredFrom) {
  CarriedSensor c = carried({.seconds = 60.0});
  for (TriadColumns* t : {&c.sensor.acceleration, &c.sensor.angular_velocity, &c.sensor.field})
    set(*t, 20 * 200, 23 * 200, Vec3::Constant(std::nan("")));
  flag_faults(c.sensor);
  for (const FilterOptions& options : {FilterOptions(KinferFilterOptions{}), FilterOptions(KinferOfflineOptions{})}) {
    const auto q = estimate_orientations(c.sensor, c.time, options);
    std::vector<char> later(q.size(), 0);
    std::fill(later.begin() + 35 * 200, later.end(), char{1});
    EXPECT_LT(orientation_error(q, c.truth, later).inclination, 0.5 * degree);
    EXPECT_LT(orientation_error(q, c.truth, later).heading, 3.0 * degree) << "12 s after it";
  }
}

TEST(BadInput, ARowInTenMissingCostsLittle) {
  CarriedSensor c = carried({.has_magnetometer = false});
  for (std::size_t row = 5; row < c.time.size(); row += 10)
    for (TriadColumns* t : {&c.sensor.acceleration, &c.sensor.angular_velocity})
      for (auto& axis : t->axis) axis[row] = nan_value;
  flag_faults(c.sensor);
  const auto q = estimate_orientations(c.sensor, c.time, KinferFilterOptions{});
  const auto e = orientation_error(q, c.truth, std::vector<char>(q.size(), 1), HeadingOffset::best_constant);
  EXPECT_LT(e.inclination, 0.5 * degree);
  EXPECT_LT(e.heading, 1.0 * degree);
}

TEST(BadInput, AClippedRotationIsRecoveredFromWithAMagnetometer) {
  CarriedSensor c = carried({.seconds = 60.0, .rest = 10.0, .pace = 1.5});
  for (auto& axis : c.sensor.angular_velocity.axis)
    for (float& w : axis) w = std::clamp(w, -2.1816616f, 2.1816616f);  // 125 °/s
  flag_faults(c.sensor);
  ASSERT_GT(count(c.sensor, angular_velocity_clipped), 200u);
  const auto q = estimate_orientations(c.sensor, c.time, KinferFilterOptions{});
  std::vector<char> later(q.size(), 0);
  std::fill(later.begin() + 55 * 200, later.end(), char{1});
  EXPECT_LT(orientation_error(q, c.truth, later).inclination, 0.5 * degree);
  EXPECT_LT(orientation_error(q, c.truth, later).heading, 5.0 * degree);
}

}  // namespace
}  // namespace kinfer
