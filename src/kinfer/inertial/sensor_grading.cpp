// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/sensor_grading.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/inertial/clipped_peaks.hpp"
#include "kinfer/inertial/filters/kinfer_smoother.hpp"
#include "kinfer/inertial/rest/steady_rotation.hpp"
#include "kinfer/inertial/thresholds.hpp"

namespace kinfer {
namespace {

/// White noise density from differences of consecutive rows, insensitive to slow drift.
Vec3 noise_density_at_rest(const TriadColumns& triad, std::span<const double> time,
                           std::span<const RestPeriod> rest_periods) {
  Vec3 sum = Vec3::Zero();
  double n = 0.0;
  for (const RestPeriod& rest : rest_periods)
    for (std::size_t row = rest.first_row + 1; row <= rest.last_row; ++row) {
      const Vec3 difference = triad.at(row) - triad.at(row - 1);
      if (!difference.allFinite()) continue;
      sum += (time[row] - time[row - 1]) * difference.cwiseAbs2();  // 2 dt · sd², and a difference has 2 sd²
      n += 1.0;
    }
  return n > 0.0 ? Vec3((sum / n).cwiseSqrt()) : Vec3(Vec3::Zero());
}

/// Quantisation step: the smallest difference of consecutive rows above float rounding; 0 if there is none.
double resolution(const TriadColumns& triad, std::span<const RestPeriod> rest_periods) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const RestPeriod& rest : rest_periods)
    for (std::size_t row = rest.first_row + 1; row <= rest.last_row; ++row)
      for (const auto& axis : triad.axis) {
        const double step = std::abs(double{axis[row]} - double{axis[row - 1]});
        const double rounding = 4e-7 * std::abs(double{axis[row]});
        if (step > rounding) smallest = std::min(smallest, step);
      }
  return std::isfinite(smallest) ? smallest : 0.0;
}

double largest(const TriadColumns& triad) {
  float found = 0.0f;
  for (const auto& axis : triad.axis)
    for (const float value : axis)
      if (std::isfinite(value)) found = std::max(found, std::abs(value));
  return found;
}

InsSensor excerpt(const InsSensor& sensor, std::size_t first, std::size_t count) {
  InsSensor part{.name = sensor.name, .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  const auto cut = [&](const auto& rows) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
    return std::decay_t<decltype(rows)>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  for (const auto& [from, to] :
       {std::pair{&sensor.acceleration, &part.acceleration}, {&sensor.angular_velocity, &part.angular_velocity}})
    for (std::size_t k = 0; k < 3; ++k) to->axis[k] = cut(from->axis[k]);
  part.faults = cut(sensor.faults);
  return part;
}

/// [rad²/s²] sum of squared rates over the rows: how much the part excites the gyro's scale errors.
double squared_rotation(const InsSensor& part) {
  double sum = 0.0;
  for (const auto& axis : part.angular_velocity.axis)
    for (const float angular_velocity : axis)
      if (std::isfinite(angular_velocity)) sum += double{angular_velocity} * double{angular_velocity};
  return sum;
}

/// Rms of the gyro's scale matrix estimated by the smoother. The smoother models scale and bias as more constant than
/// they are, so the figure would grow with the length of the recording: for a long one it is the median over the most
/// active minutes.
double scale_error(const InsSensor& sensor, std::span<const double> time) {
  const double length = time.back() - time.front();
  if (length < inertial::undivided_duration) return smooth_orientation(sensor, time).scale.norm() / 3.0;
  const auto rows = static_cast<std::size_t>(static_cast<double>(time.size()) * inertial::scale_excerpt / length);
  std::vector<std::pair<double, std::size_t>> parts;  // turning, first row
  for (std::size_t first = 0; first + rows <= time.size(); first += rows)
    parts.emplace_back(-squared_rotation(excerpt(sensor, first, rows)), first);
  std::ranges::sort(parts);
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(inertial::scale_excerpts, parts.size()); ++i)
    errors.push_back(
        smooth_orientation(excerpt(sensor, parts[i].second, rows), time.subspan(parts[i].second, rows)).scale.norm() /
        3.0);
  return median(errors);
}

/// Negative log likelihood of a zero-mean figure under a standard deviation, up to a constant.
double negative_log_likelihood(double figure, double sd) {
  return std::log(sd) + 0.5 * figure * figure / (sd * sd);
}

double negative_log_likelihood(const SensorStatistics& found, const SensorModel& grade) {
  const double rate_sd = std::hypot(grade.gyroscope.bias_sd, inertial::rest_rate_floor),
               gravity_sd = std::hypot(grade.accelerometer.bias_sd, inertial::gravity_floor);
  const double scale_sd = std::hypot(grade.gyroscope.scale_sd, inertial::scale_floor);
  double sum =
      negative_log_likelihood(found.gravity_error, gravity_sd) + negative_log_likelihood(found.scale_error, scale_sd);
  for (const double bias : found.gyroscope_bias.mean) sum += negative_log_likelihood(bias, rate_sd);
  const double noise = std::log(std::max(found.rate_density.mean(), 1e-7) / grade.gyroscope.noise_density);
  return sum + 0.5 * noise * noise;
}

}  // namespace

SensorStatistics sensor_statistics(const InsSensor& sensor, std::span<const double> time,
                                   std::span<const RestPeriod> rest_periods) {
  SensorStatistics found;
  found.gyroscope_bias = bias_at_rest(rest_periods);
  found.rest_seconds = found.gyroscope_bias.seconds;
  found.rate_density = noise_density_at_rest(sensor.angular_velocity, time, rest_periods);
  found.acceleration_density = noise_density_at_rest(sensor.acceleration, time, rest_periods);
  found.rate_resolution = resolution(sensor.angular_velocity, rest_periods);
  found.acceleration_resolution = resolution(sensor.acceleration, rest_periods);
  if (sensor.has_magnetometer()) {
    found.field_density = noise_density_at_rest(sensor.field, time, rest_periods);
    found.field_resolution = resolution(sensor.field, rest_periods);
  }
  for (const RestPeriod& rest : rest_periods) {
    const double error = rest.acceleration.norm() - standard_gravity;
    found.gravity_error += rest.seconds() / found.rest_seconds * error * error;
  }
  found.gravity_error = std::sqrt(found.gravity_error);
  found.largest_rate = largest(sensor.angular_velocity);
  found.largest_acceleration = largest(sensor.acceleration);
  found.scale_error = scale_error(restore_clipped_peaks(sensor, time), time);
  return found;
}

SensorModel estimate_sensor_model(const SensorStatistics& found) {
  SensorModel best = *sensor_grade("consumer");
  if (found.rest_seconds <= 0.0) return best;
  for (const std::string_view name : sensor_grade_names) {
    const SensorModel grade = *sensor_grade(name);
    if (negative_log_likelihood(found, grade) < negative_log_likelihood(found, best)) best = grade;
  }
  best.gyroscope.noise_density =
      std::max(found.rate_density.maxCoeff(), inertial::min_density_share * best.gyroscope.noise_density);
  best.accelerometer.noise_density =
      std::max(found.acceleration_density.maxCoeff(), inertial::min_density_share * best.accelerometer.noise_density);
  if (found.field_density.maxCoeff() > 0.0) best.magnetometer.noise_density = found.field_density.maxCoeff();
  return best;
}

SensorModel estimate_sensor_model(const InsRecording& recording) {
  const auto rank = [](const SensorModel& model) {
    return std::ranges::find(sensor_grade_names, model.name) - sensor_grade_names.begin();
  };
  SensorModel worst = *sensor_grade(sensor_grade_names.front());
  const auto rests = rest_periods_of(recording);
  for (std::size_t s = 0; s < rests.size(); ++s) {
    const InsSensor& sensor = recording.sensors[s];
    const SensorModel model = estimate_sensor_model(sensor_statistics(sensor, recording.time(sensor), rests[s]));
    if (rank(model) > rank(worst) || &sensor == &recording.sensors.front())
      worst = rank(model) >= rank(worst) ? model : worst;
  }
  return worst;
}

}  // namespace kinfer
