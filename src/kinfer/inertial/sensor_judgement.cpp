#include "kinfer/inertial/sensor_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
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

InsSensor rows_of(const InsSensor& sensor, std::size_t first, std::size_t count) {
  InsSensor part{.name = sensor.name, .acceleration = {}, .rate = {}, .field = {}, .faults = {}};
  const auto cut = [&](const auto& rows) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
    return std::decay_t<decltype(rows)>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  for (const auto& [from, to] : {std::pair{&sensor.acceleration, &part.acceleration}, {&sensor.rate, &part.rate}})
    for (std::size_t k = 0; k < 3; ++k) to->axis[k] = cut(from->axis[k]);
  part.faults = cut(sensor.faults);
  return part;
}

/// [rad²/s²] sum over the part's rows: how much it shows of the gyro's scale.
double turning(const InsSensor& part) {
  double sum = 0.0;
  for (const auto& axis : part.rate.axis)
    for (const float rate : axis)
      if (std::isfinite(rate)) sum += double{rate} * double{rate};
  return sum;
}

/// Rms of the gyro's scale matrix as the smoother finds it. The smoother takes scale and bias for less changing than
/// they are, so the figure would grow with a recording's length: of a long one the liveliest minutes are asked, one by
/// one.
double scale_error(const InsSensor& sensor, std::span<const double> time) {
  constexpr double minute = 60.0;       // [s]
  constexpr std::size_t liveliest = 5;  // minutes
  const double length = time.back() - time.front();
  if (length < 2.0 * minute) return smoothed_motion(sensor, time).scale.norm() / 3.0;
  const auto rows = static_cast<std::size_t>(static_cast<double>(time.size()) * minute / length);
  std::vector<std::pair<double, std::size_t>> parts;  // turning, first row
  for (std::size_t first = 0; first + rows <= time.size(); first += rows)
    parts.emplace_back(-turning(rows_of(sensor, first, rows)), first);
  std::ranges::sort(parts);
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(liveliest, parts.size()); ++i)
    errors.push_back(
        smoothed_motion(rows_of(sensor, parts[i].second, rows), time.subspan(parts[i].second, rows)).scale.norm() /
        3.0);
  return median(errors);
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
  found.scale_error = scale_error(sensor, time);
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
