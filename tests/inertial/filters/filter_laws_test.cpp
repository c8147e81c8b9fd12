// SPDX-License-Identifier: Apache-2.0
// Laws of every orientation filter.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "kinfer/inertial/filters/orientation.hpp"
#include "support/carried_sensor.hpp"
#include "support/orientation_error.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedMotion;
using testing::CarriedSensor;
using testing::HeadingOffset;
using testing::orientation_error;
using testing::OrientationError;

struct Case {
  std::string name;
  FilterOptions options;
  double accuracy;  // [rad] total rms on an error-free moving sensor
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class EveryFilter : public ::testing::TestWithParam<Case> {
 protected:
  std::vector<Quat> run(const CarriedSensor& c) const {
    return estimate_orientations(c.sensor, c.time, GetParam().options);
  }
};

double largest_angle(const std::vector<Quat>& a, const std::vector<Quat>& b, std::size_t from = 0) {
  double largest = 0.0;
  for (std::size_t i = from; i < a.size(); ++i) largest = std::max(largest, a[i].angularDistance(b[i]));
  return largest;
}

double total(const CarriedSensor& c, const std::vector<Quat>& q) {
  return orientation_error(q, c.truth, std::vector<char>(q.size(), 1)).total;
}

double inclination(const CarriedSensor& c, const std::vector<Quat>& q) {
  return orientation_error(q, c.truth, std::vector<char>(q.size(), 1)).inclination;
}

TEST_P(EveryFilter, TheOrientationOfAMovingSensorIsFollowed) {
  const CarriedSensor c = carried({});
  EXPECT_LT(total(c, run(c)), GetParam().accuracy);
}

TEST_P(EveryFilter, RotatingTheFieldRotatesTheResult) {
  constexpr double turn = 0.7;
  const auto straight = run(carried({}));
  auto turned = run(carried({.declination = turn}));
  for (Quat& q : turned) q = quat_exp(Vec3(0, 0, turn)) * q;
  // Not to the last digit: the motion is not rotated with the field, so small errors of the filter differ.
  EXPECT_LT(largest_angle(straight, turned), GetParam().accuracy / 6);
}

TEST_P(EveryFilter, RotatingTheSensorInItsHousingRotatesTheResult) {
  const Quat mounting(from_rpy({0.8, -0.5, 2.0}));
  const auto straight = run(carried({}));
  auto turned = run(carried({.mounting = mounting}));
  for (Quat& q : turned) q = q * mounting.conjugate();
  EXPECT_LT(largest_angle(straight, turned), 1e-3);
}

/// Samples of an instrument of a lower rate: means over `n` rows, at the time of the last.
CarriedSensor decimated(const CarriedSensor& c, std::size_t n) {
  CarriedSensor out;
  for (std::size_t row = n; row < c.time.size(); row += n) {
    Vec3 force = Vec3::Zero(), angular_velocity = Vec3::Zero(), field = Vec3::Zero();
    for (std::size_t i = row - n + 1; i <= row; ++i)
      force += c.sensor.acceleration.at(i), angular_velocity += c.sensor.angular_velocity.at(i),
          field += c.sensor.field.at(i);
    testing::append(out.sensor.acceleration, force / double(n));
    testing::append(out.sensor.angular_velocity, angular_velocity / double(n));
    testing::append(out.sensor.field, field / double(n));
    out.time.push_back(c.time[row]);
    out.truth.push_back(c.truth[row]);
  }
  flag_faults(out.sensor);
  return out;
}

TEST_P(EveryFilter, HalfAndAQuarterOfTheRateGiveTheSameResultWithinHalfADegree) {
  const CarriedSensor full = carried({.sampling_rate = 400.0});
  const auto reference = run(full);
  for (const std::size_t n : {2, 4}) {
    const CarriedSensor fewer = decimated(full, n);
    const auto answer = run(fewer);
    double sum = 0.0;
    for (std::size_t k = 0; k < answer.size(); ++k)
      sum += std::pow(answer[k].angularDistance(reference[(k + 1) * n]), 2);
    EXPECT_LT(std::sqrt(sum / static_cast<double>(answer.size())), 0.5 * degree) << "every " << n << "th row";
  }
}

TEST_P(EveryFilter, AStationarySensorDoesNotDrift) {
  const SensorModel grade = *sensor_grade("industrial");
  const CarriedSensor c = carried({.seconds = 200.0, .sampling_rate = 50.0, .rest = 1000.0, .grade = &grade});
  const auto q = run(c);
  EXPECT_LT(q[60 * 50].angularDistance(q.back()), std::max(0.5 * degree, GetParam().accuracy / 4))
      << "from one minute on";
}

TEST_P(EveryFilter, TheSameInputGivesTheSameBits) {
  const CarriedSensor c = carried({.seconds = 10.0});
  const auto a = run(c), b = run(c);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(a[i].coeffs() == b[i].coeffs());
}

/// Every row of the table; a filter that states no accuracy of its own must reach that of the paper's.
std::vector<Case> cases() {
  const std::map<std::string_view, double> stated{{"kinfer", 0.6}, {"kinfer-offline", 0.4}};  // [°]
  std::vector<Case> all{{"paper_iterated", PaperEkfOptions{.iterations = 3}, 4.0 * degree}};
  for (const OrientationFilter& filter : orientation_filters()) {
    const auto own = stated.find(filter.name);
    all.push_back(
        {std::string(filter.name), filter.default_options, (own == stated.end() ? 4.0 : own->second) * degree});
    std::ranges::replace(all.back().name, '-', '_');
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Filters, EveryFilter, ::testing::ValuesIn(cases()),
                         [](const auto& chosen) { return chosen.param.name; });

TEST(KinferOffline, TimeReversalGivesTheSameTilt) {
  const SensorModel grade = *sensor_grade("noise");
  const CarriedSensor forward = carried({.grade = &grade, .has_magnetometer = false});
  CarriedSensor back;
  const std::size_t n = forward.time.size();
  for (std::size_t k = 0; k < n; ++k) {  // backward, the interval before a row is the one after it
    const std::size_t from = k == 0 ? n - 1 : n - k;
    testing::append(back.sensor.acceleration, forward.sensor.acceleration.at(from));
    testing::append(back.sensor.angular_velocity, -forward.sensor.angular_velocity.at(from));
    back.time.push_back(static_cast<double>(k) / 200.0);
  }
  flag_faults(back.sensor);
  const auto a = estimate_orientations(forward.sensor, forward.time, KinferOfflineOptions{});
  auto b = estimate_orientations(back.sensor, back.time, KinferOfflineOptions{});
  std::ranges::reverse(b);
  const OrientationError e = orientation_error(b, a, std::vector<char>(n, 1), HeadingOffset::best_constant);
  EXPECT_LT(e.inclination, 0.05 * degree);
  EXPECT_LT(e.heading, 0.2 * degree);
}

TEST(KinferOffline, SmoothingEstimatesTheTiltBetterThanFiltering) {
  const SensorModel grade = *sensor_grade("industrial");
  for (const double scale_sd : {2e-3, 0.0})
    for (const int seed : {1, 2, 3}) {
      const CarriedSensor c = carried({.pace = 2.0, .grade = &grade, .seed = seed});
      KinferOfflineOptions offline;
      KinferFilterOptions online;
      online.scale_sd = offline.filter.scale_sd = scale_sd;
      EXPECT_LT(inclination(c, estimate_orientations(c.sensor, c.time, offline)),
                inclination(c, estimate_orientations(c.sensor, c.time, online)))
          << "seed " << seed << ", scale errors of " << scale_sd;
    }
}

}  // namespace
}  // namespace kinfer
