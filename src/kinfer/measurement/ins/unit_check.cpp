// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/ins/unit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"

namespace kinfer {
namespace {

constexpr double fastest_gyroscope = 4200 * degree;  // [rad/s] beyond the range of any real sensor

bool is_complete(const TriadColumns& triad, std::size_t row) {
  return triad.at(row).allFinite();
}

bool is_nothing(const TriadColumns& triad, std::size_t row) {
  return triad.at(row).squaredNorm() <= 0.0;
}

double middle_of(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double lower_tenth_of(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 10);
  std::ranges::nth_element(values, rank);
  return *rank;
}

double median_norm(const TriadColumns& triad) {
  std::vector<double> norms;
  const std::size_t rows = triad.axis[0].size();
  const std::size_t stride = std::max<std::size_t>(1, rows / 20000);  // enough for a median
  for (std::size_t row = 0; row < rows; row += stride)
    if (is_complete(triad, row) && !is_nothing(triad, row)) norms.push_back(triad.at(row).norm());
  return middle_of(norms);
}

/// Specific force where the sensor hardly rotates: on a wheel the centrifugal acceleration exceeds gravity.
struct GravityReading {
  double value = 0.0;      // [m/s²] median
  double lower = 0.0;      // [m/s²] a tenth of the readings is less
  bool is_at_rest = true;  // false: the sensor rotates all the time
};

GravityReading read_gravity(const InsSensor& sensor) {
  constexpr double slow_rate = 0.5;  // [rad/s]
  constexpr std::size_t min_slow_rows = 20;
  std::vector<double> norms;
  bool has_rates = false;
  const std::size_t rows = sensor.angular_velocity.present() ? sensor.acceleration.axis[0].size() : 0;
  for (std::size_t row = 0; row < rows; ++row) {
    if (!is_complete(sensor.acceleration, row) || is_nothing(sensor.acceleration, row)) continue;
    if (!is_complete(sensor.angular_velocity, row)) continue;
    has_rates = true;
    if (sensor.angular_velocity.at(row).norm() < slow_rate) norms.push_back(sensor.acceleration.at(row).norm());
  }
  if (norms.size() >= min_slow_rows) return {middle_of(norms), lower_tenth_of(norms)};
  const double all = median_norm(sensor.acceleration);
  return {all, all, !has_rates};
}

constexpr double gravity_tolerance = 0.15;  // of gravity: biases and scale errors of cheap accelerometers, and motion

bool is_gravity(double value, double unit) {
  return std::abs(unit * value / standard_gravity - 1.0) < gravity_tolerance;
}

void check_gravity_unit(const InsSensor& sensor, std::vector<UnitWarning>& warnings) {
  const GravityReading reading = read_gravity(sensor);
  const double gravity = reading.value;
  const double largest = reading.is_at_rest ? 2.0 * standard_gravity : 50.0 * standard_gravity;
  if (gravity <= 0.0 || (gravity > 0.7 * standard_gravity && gravity < largest)) return;
  const bool is_other_unit = acceleration_unit(sensor).has_value();
  if (lacks_gravity(sensor))
    warnings.push_back(
        {fmt::format("{0}: {0}_ax, {0}_ay, {0}_az hold no gravity (they read {1:.2g} at rest): linear or "
                     "free acceleration, which cannot be mended; export what the accelerometer measures",
                     sensor.name, gravity),
         true});
  else if (gravity > 0.7 && gravity < 1.5)
    warnings.push_back({fmt::format("{0}: gravity reads {1:.3g} m/s²: the file seems to be in g; write the headers as "
                                    "{0}_ax[g], {0}_ay[g], {0}_az[g]",
                                    sensor.name, gravity),
                        true, is_other_unit});
  else
    warnings.push_back({fmt::format("{0}: gravity reads {1:.3g} m/s², expected about 9.81: state the unit of {0}_ax, "
                                    "{0}_ay, {0}_az in brackets, or check the sensor",
                                    sensor.name, gravity),
                        true, is_other_unit});
}

void check_angular_velocity_unit(const InsSensor& sensor, std::vector<UnitWarning>& warnings) {
  std::size_t impossible = 0, rows = 0;
  double fastest = 0.0;
  for (std::size_t row = 0; row < sensor.angular_velocity.axis[0].size(); ++row) {
    if (!is_complete(sensor.angular_velocity, row)) continue;
    const double angular_velocity = sensor.angular_velocity.at(row).cwiseAbs().maxCoeff();
    ++rows;
    if (angular_velocity > fastest_gyroscope) ++impossible, fastest = std::max(fastest, angular_velocity);
  }
  if (impossible * 1000 > rows)  // fewer are corrupt rows, and are flagged
    warnings.push_back(
        {fmt::format("{0}: the angular rate reaches {1:.3g} rad/s, which no such sensor can measure: the "
                     "file seems to be in °/s; write the headers as {0}_gx[deg/s], {0}_gy[deg/s], "
                     "{0}_gz[deg/s]",
                     sensor.name, fastest),
         true, true, 1});
}

void check_field_unit(const InsSensor& sensor, std::vector<UnitWarning>& warnings) {
  const double field = median_norm(sensor.field);
  if (field <= 0.0)
    warnings.push_back(
        {fmt::format("{}: the magnetometer says nothing but zeros: it is not used", sensor.name), false, false, 2});
  else if (field < 8.0 || field > 500.0)
    warnings.push_back(
        {fmt::format("{0}: the magnetic field reads {1:.3g} µT, the Earth's is 25 to 65: it is not used; "
                     "state its unit in brackets, {0}_mx[1] where it is arbitrary",
                     sensor.name, field),
         false, field_unit(sensor).has_value(), 2});
}

}  // namespace

std::optional<double> clock_unit(const InsLogger& logger) {
  if (logger.states_unit) return 1.0;
  const double period = sample_period(logger.time);
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9})
    if (period * unit <= longest_sample_period) return unit;
  return std::nullopt;
}

std::optional<double> acceleration_unit(const InsSensor& sensor) {
  const GravityReading gravity = read_gravity(sensor);
  for (const double unit : {1.0, standard_gravity, 1e-3 * standard_gravity, 1e-3})
    if (is_gravity(gravity.value, unit) && unit * gravity.lower > 0.7 * standard_gravity) return unit;
  return std::nullopt;
}

bool lacks_gravity(const InsSensor& sensor) {
  const GravityReading gravity = read_gravity(sensor);
  return gravity.is_at_rest && gravity.value > 0.0 && gravity.value < 0.6 * standard_gravity && gravity.lower < 0.6;
}

std::optional<double> field_unit(const InsSensor& sensor) {
  constexpr double weakest = 18.0, strongest = 90.0;  // [µT] Earth's field with some iron
  const double field = median_norm(sensor.field);
  for (const double unit : {1.0, 100.0, 1e3, 1e6, 1e-3})
    if (unit * field > weakest && unit * field < strongest) return unit;
  return std::nullopt;
}

std::vector<UnitWarning> check_units(const InsSensor& sensor, bool field_has_unit) {
  std::vector<UnitWarning> warnings;
  check_gravity_unit(sensor, warnings);
  check_angular_velocity_unit(sensor, warnings);
  if (sensor.has_magnetometer() && (!field_has_unit || median_norm(sensor.field) <= 0.0))
    check_field_unit(sensor, warnings);
  return warnings;
}

}  // namespace kinfer
