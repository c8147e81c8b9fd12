// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_orientations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/inertial/segment_motion.hpp"
#include "support/carried_sensor.hpp"
#include "support/orientation_error.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;
using testing::orientation_error;

InsRecording recording_of(const std::vector<CarriedSensor>& sensors) {
  InsRecording recording;
  for (const CarriedSensor& c : sensors) {
    recording.loggers.push_back({"log", c.time});
    recording.sensors.push_back(c.sensor);
    recording.sensors.back().logger = recording.loggers.size() - 1;
    recording.sensors.back().name = "imu" + std::to_string(recording.sensors.size());
  }
  return recording;
}

/// Without rates from 20 s on, for `seconds`.
CarriedSensor with_gap(CarriedSensor c, double seconds) {
  for (std::size_t row = 0; row < c.time.size(); ++row)
    if (c.time[row] >= 20.0 && c.time[row] < 20.0 + seconds)
      for (auto& axis : c.sensor.angular_velocity.axis) axis[row] = std::nanf("");
  flag_faults(c.sensor);
  return c;
}

std::vector<Quat> estimate(const CarriedSensor& c, const FilterOptions& options) {
  const std::vector<std::size_t> first{0};
  return estimate_orientations(recording_of({c}), first, options).value()[0].world_q_sensor;
}

TEST(SensorOrientations, AreThoseOfTheFilterOnALogWithoutGaps) {
  const CarriedSensor c = carried({.seconds = 12.0, .sampling_rate = 100.0});
  for (const OrientationFilter& filter : orientation_filters()) {
    const auto q = estimate(c, filter.default_options),
               expected = estimate_orientations(c.sensor, c.time, filter.default_options);
    ASSERT_EQ(q.size(), expected.size());
    for (std::size_t i = 0; i < q.size(); ++i) ASSERT_TRUE(q[i].coeffs() == expected[i].coeffs()) << filter.name;
  }
}

TEST(SensorOrientations, ACausalFilterDoesNotDependOnLaterRows) {
  const CarriedSensor whole = with_gap(carried({.seconds = 30.0, .sampling_rate = 100.0}), 0.2);
  CarriedSensor start = whole;
  const std::size_t rows = 2010;  // within the gap
  start.time.resize(rows), start.truth.resize(rows), start.sensor.faults.resize(rows);
  for (TriadColumns* triad : {&start.sensor.acceleration, &start.sensor.angular_velocity, &start.sensor.field})
    for (auto& axis : triad->axis) axis.resize(rows);
  for (const OrientationFilter& filter : orientation_filters()) {
    const auto early = estimate(start, filter.default_options), all = estimate(whole, filter.default_options);
    double largest = 0.0;
    for (std::size_t i = 0; i < rows; ++i) largest = std::max(largest, early[i].angularDistance(all[i]));
    EXPECT_EQ(largest == 0.0, filter.is_causal) << filter.name << ": " << largest;
  }
}

TEST(SensorOrientations, TheSmootherIsCloserToTheTruthWithShortGapsBridged) {
  for (const double seconds : {0.05, 0.15, 0.3}) {
    const CarriedSensor c = with_gap(carried({.seconds = 40.0}), seconds);
    const std::vector<char> all(c.time.size(), 1);
    const double bridged = orientation_error(estimate(c, KinferOfflineOptions{}), c.truth, all).total,
                 raw = orientation_error(estimate_orientations(c.sensor, c.time, KinferOfflineOptions{}), c.truth, all)
                           .total;
    EXPECT_LE(bridged, 1.001 * raw) << seconds << " s: " << bridged / degree << "° instead of " << raw / degree;
  }
}

TEST(SensorOrientations, SayWhereTheHeadingComesFromAndHowLongTheSensorRested) {
  const InsRecording recording =
      recording_of({carried({.seconds = 20.0, .rest = 5.0}), carried({.seconds = 20.0, .has_magnetometer = false})});
  const std::vector<std::size_t> both{1, 0};
  const auto found = estimate_orientations(recording, both, KinferFilterOptions{}).value();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].sensor, 1u);
  EXPECT_FALSE(found[0].heading_is_north);
  EXPECT_TRUE(found[1].heading_is_north);
  EXPECT_NEAR(found[1].rest_seconds, 10.0, 2.5) << "5 s at either end, without margins and detection";
  const auto off = estimate_orientations(recording, both, without_magnetometer(KinferFilterOptions{})).value();
  EXPECT_FALSE(off[1].heading_is_north);
}

TEST(SensorOrientations, ASensorWithoutSpecificForceIsRefused) {
  CarriedSensor c = carried({.seconds = 5.0});
  for (std::uint8_t& bits : c.sensor.faults) bits |= acceleration_missing;
  const std::vector<std::size_t> first{0};
  const auto found = estimate_orientations(recording_of({c}), first, KinferFilterOptions{});
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().what.find("sensor imu1: no row has a specific force"), std::string::npos);
}

TEST(OrientationFilters, OptionsFindTheirRow) {
  for (const OrientationFilter& filter : orientation_filters()) {
    EXPECT_EQ(&filter_of(filter.default_options), &filter);
    EXPECT_EQ(filter_named(filter.name)->index(), filter.default_options.index());
    EXPECT_NE(filter_names().find(filter.name), std::string::npos);
    EXPECT_NE(filter_help().find(filter.help), std::string::npos);
  }
  EXPECT_FALSE(filter_named("madgwick").has_value());
}

TEST(OrientationFilters, GyroErrorsAreInTheOutputOfThoseThatEstimateThem) {
  const CarriedSensor c = carried({.seconds = 12.0, .sampling_rate = 100.0});
  for (const OrientationFilter& filter : orientation_filters()) {
    const FilterOutput output = run_filter(c.sensor, c.time, filter.default_options);
    EXPECT_EQ(output.bias.size(), output.bias_time.size()) << filter.name;
    EXPECT_EQ(!output.bias.empty(), filter.estimates_gyro_errors) << filter.name;
  }
}

TEST(OrientationFilters, WithoutMagnetometerTheFieldHasNoEffect) {
  const CarriedSensor c = carried({.seconds = 12.0, .sampling_rate = 100.0});
  CarriedSensor other = c;
  for (float& x : other.sensor.field.axis[0]) x += 30.0f;
  for (const OrientationFilter& filter : orientation_filters()) {
    const FilterOptions options = without_magnetometer(filter.default_options);
    EXPECT_EQ(magnetometer_use(options), MagnetometerUse::off);
    EXPECT_EQ(magnetometer_use(filter.default_options), MagnetometerUse::automatic);
    const auto a = estimate_orientations(c.sensor, c.time, options),
               b = estimate_orientations(other.sensor, other.time, options);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(a[i].coeffs() == b[i].coeffs()) << filter.name;
  }
}

TEST(OrientationFilters, AWiderBiasLimitFindsTheBiasOfAPoorGyroAtItsFirstRest) {
  CarriedSensor c = carried({.seconds = 20.0, .sampling_rate = 100.0, .rest = 6.0, .has_magnetometer = false});
  for (float& x : c.sensor.angular_velocity.axis[2]) x += 0.07f;  // 4 °/s about the vertical when level
  for (const OrientationFilter& filter : orientation_filters()) {
    if (!filter.set_max_initial_bias) continue;
    const auto drift = [&](const FilterOptions& options) {
      const auto q = estimate_orientations(c.sensor, c.time, options);
      return q[400].angularDistance(q[580]);  // at rest
    };
    EXPECT_GT(drift(filter.default_options), 2.0 * degree) << filter.name;
    EXPECT_LT(drift(with_max_initial_bias(filter.default_options, 0.09)), 0.2 * degree) << filter.name;
  }
}

TEST(OrientationFilters, ABiasThatIsKnownIsNotSoughtInMotion) {
  const Vec3 bias(0.02, -0.015, 0.03);  // [rad/s]
  CarriedSensor c = carried({.seconds = 30.0, .sampling_rate = 100.0, .rest = -2.0, .has_magnetometer = false});
  for (std::size_t k = 0; k < 3; ++k)
    for (float& x : c.sensor.angular_velocity.axis[k]) x += static_cast<float>(bias[static_cast<Eigen::Index>(k)]);
  ASSERT_TRUE(rest_periods(c.sensor, c.time).empty());
  const auto turned_too_far = [&](const FilterOptions& options) {
    const auto q = estimate_orientations(c.sensor, c.time, options);
    const std::size_t from = 500;  // by then gravity has told the tilt
    return (q[from].conjugate() * q.back()).angularDistance(c.truth[from].conjugate() * c.truth.back());
  };
  for (const OrientationFilter& filter : orientation_filters()) {
    const FilterOptions known = with_bias(filter.default_options, bias, 5e-4);
    if (!filter.set_bias) {
      EXPECT_EQ(turned_too_far(known), turned_too_far(filter.default_options)) << filter.name;
      continue;
    }
    EXPECT_GT(turned_too_far(filter.default_options), 3.0 * degree) << filter.name;
    EXPECT_LT(turned_too_far(known), 1.0 * degree) << filter.name;
  }
}

TEST(SegmentMotion, CarriesTheGravityThatItSubtracted) {
  const InsRecording recording = recording_of({carried({.seconds = 10.0, .sampling_rate = 100.0}),
                                               carried({.seconds = 10.0, .sampling_rate = 100.0, .seed = 2})});
  const auto standard = segment_motion(recording).value();
  const auto heavier = segment_motion(recording, {.gravity = 9.83}).value();
  EXPECT_EQ(standard.gravity, 9.80665);
  EXPECT_EQ(heavier.gravity, 9.83);
  const std::size_t row = standard.rows() / 2;
  const Vec3 difference = standard.segments[0].acceleration[row] - heavier.segments[0].acceleration[row];
  EXPECT_LT((difference - Vec3(0, 0, 9.83 - 9.80665)).norm(), 1e-9);
}

}  // namespace
}  // namespace kinfer
