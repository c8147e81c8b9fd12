#include "kinfer/inertial/sensor_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/inertial/kinfer_offline.hpp"

namespace kinfer {
namespace {

constexpr double standard_gravity = 9.80665;  // [m/s²]

/// White noise density from differences of neighbouring rows, which a slow drift hardly touches.
Vec3 density(const TriadColumns& triad, std::span<const double> time, std::span<const Rest> rests) {
  Vec3 sum = Vec3::Zero();
  double n = 0.0;
  for (const Rest& rest : rests)
    for (std::size_t row = rest.first_row + 1; row <= rest.last_row; ++row) {
      const Vec3 difference = triad.at(row) - triad.at(row - 1);
      if (!difference.allFinite()) continue;
      sum += (time[row] - time[row - 1]) * difference.cwiseAbs2();  // 2 dt · sd², and a difference has 2 sd²
      n += 1.0;
    }
  return n > 0.0 ? Vec3((sum / n).cwiseSqrt()) : Vec3(Vec3::Zero());
}

/// The step that most neighbouring rows differ by at least: one count, or nothing where no such step repeats.
double resolution(const TriadColumns& triad, std::span<const Rest> rests) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Rest& rest : rests)
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

/// Negative log likelihood of a zero-mean figure under a standard deviation, up to a constant.
double surprise(double figure, double sd) {
  return std::log(sd) + 0.5 * figure * figure / (sd * sd);
}

double surprise(const SensorFindings& found, const SensorModel& grade) {
  // A perfect figure of a preset stands for "too small to see": the noise of a rest's mean and of gravity on Earth.
  const double rate_sd = std::hypot(grade.gyroscope.bias_sd, 2e-4),
               gravity_sd = std::hypot(grade.accelerometer.bias_sd, 0.02);
  const double scale_sd = std::hypot(grade.gyroscope.scale_sd, 5e-4);
  double sum = surprise(found.gravity_error, gravity_sd) + surprise(found.scale_error, scale_sd);
  for (const double bias : found.rate_bias.mean) sum += surprise(bias, rate_sd);
  const double noise = std::log(std::max(found.rate_density.mean(), 1e-7) / grade.gyroscope.noise_density);
  return sum + 0.5 * noise * noise;
}

}  // namespace

SensorFindings findings(const InsSensor& sensor, std::span<const double> time, std::span<const Rest> rests) {
  SensorFindings found;
  found.rate_bias = bias_at_rest(rests);
  found.rest_seconds = found.rate_bias.seconds;
  found.rate_density = density(sensor.rate, time, rests);
  found.acceleration_density = density(sensor.acceleration, time, rests);
  found.rate_resolution = resolution(sensor.rate, rests);
  found.acceleration_resolution = resolution(sensor.acceleration, rests);
  if (sensor.has_magnetometer()) {
    found.field_density = density(sensor.field, time, rests);
    found.field_resolution = resolution(sensor.field, rests);
  }
  for (const Rest& rest : rests) {
    const double error = rest.acceleration.norm() - standard_gravity;
    found.gravity_error += rest.seconds() / found.rest_seconds * error * error;
  }
  found.gravity_error = std::sqrt(found.gravity_error);
  found.largest_rate = largest(sensor.rate);
  found.largest_acceleration = largest(sensor.acceleration);
  found.scale_error = smoothed_motion(sensor, time).scale.norm() / 3.0;
  return found;
}

SensorModel judged_model(const SensorFindings& found) {
  SensorModel best = *sensor_grade("consumer");
  if (found.rest_seconds <= 0.0) return best;
  for (const std::string_view name : sensor_grade_names) {
    const SensorModel grade = *sensor_grade(name);
    if (surprise(found, grade) < surprise(found, best)) best = grade;
  }
  best.gyroscope.noise_density = std::max(found.rate_density.maxCoeff(), 0.1 * best.gyroscope.noise_density);
  best.accelerometer.noise_density =
      std::max(found.acceleration_density.maxCoeff(), 0.1 * best.accelerometer.noise_density);
  if (found.field_density.maxCoeff() > 0.0) best.magnetometer.noise_density = found.field_density.maxCoeff();
  return best;
}

SensorModel judged_model(const InsRecording& recording) {
  const auto rank = [](const SensorModel& model) {
    return std::ranges::find(sensor_grade_names, model.name) - sensor_grade_names.begin();
  };
  SensorModel worst = *sensor_grade(sensor_grade_names.front());
  for (const InsSensor& sensor : recording.sensors) {
    const auto time = recording.time(sensor);
    const SensorModel model = judged_model(findings(sensor, time, rests(sensor, time)));
    if (rank(model) > rank(worst) || &sensor == &recording.sensors.front())
      worst = rank(model) >= rank(worst) ? model : worst;
  }
  return worst;
}

}  // namespace kinfer
