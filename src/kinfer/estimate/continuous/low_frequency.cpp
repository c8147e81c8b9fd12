// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/low_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/continuous/model/interval_motion.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
constexpr double kernel_reach = 4.0;  // [standard deviations] of the kernel

double weight(double distance, double width) {
  const double z = distance / width;
  return std::exp(-0.5 * z * z);
}

/// Predicted measurements of one sensor at one time.
struct PredictedMeasurement {
  Vec3 angular_velocity, force;
};

PredictedMeasurement predicted_measurement(const InsState& state, const InsErrors& errors) {
  return {state.angular_velocity + errors.gyroscope_scale * state.angular_velocity + errors.gyroscope_bias,
          state.force + errors.accelerometer_scale * state.force + errors.accelerometer_bias};
}

/// Body of each sensor.
std::vector<std::size_t> bodies_of(const InsUnknowns& x) {
  std::vector<std::size_t> bodies(x.errors.size(), 0);
  for (std::size_t b = 0; b < x.bodies.size(); ++b)
    if (x.bodies[b].sensor >= 0) bodies[static_cast<std::size_t>(x.bodies[b].sensor)] = b;
  return bodies;
}

/// L over samples with finite values; NaN elsewhere.
std::vector<Vec3> smoothed(std::span<const double> time, const std::vector<Vec3>& values, double width) {
  std::vector<Vec3> result = values;
  std::size_t first = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!values[row].allFinite()) continue;
    while (time[row] - time[first] > kernel_reach * width) ++first;
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (std::size_t i = first; i < values.size() && time[i] - time[row] <= kernel_reach * width; ++i) {
      if (!values[i].allFinite()) continue;
      const double w = weight(time[i] - time[row], width);
      sum += w * values[i];
      weights += w;
    }
    result[row] = sum / weights;
  }
  return result;
}

void put(TriadColumns& columns, std::size_t row, const Vec3& value) {
  if (!value.allFinite()) return;
  for (std::size_t k = 0; k < 3; ++k) columns.axis[k][row] = static_cast<float>(value[static_cast<Index>(k)]);
}

/// Replaces the measurements of each sensor by those of the low-frequency motion.
struct LowFrequencyMachine {
  const InsProblem& problem;
  const InsUnknowns &fast, &slow;
  InsLayout layout;
  std::vector<std::size_t> body;
  double width;

  PredictedMeasurement at(const InsUnknowns& x, std::size_t sensor, double time) const {
    const auto [interval, u] = problem.grid.locate(time);
    const auto states = body_states(problem, layout, x, interval, spline_basis(u, problem.grid.period));
    return predicted_measurement(states[body[sensor]], x.errors[sensor]);
  }

  InsSensor low_frequency_sensor(const InsSensor& sensor, std::size_t index, std::span<const double> time) const {
    const Vec3 nothing = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<Vec3> angular_velocity(time.size(), nothing), force(time.size(), nothing);
    for (std::size_t row = 0; row < time.size(); ++row) {
      const InsSample s = sample(sensor, time, row);
      if (!s.has_angular_velocity && !s.has_acceleration) continue;
      const PredictedMeasurement model = at(fast, index, time[row]);
      if (s.has_angular_velocity && !s.angular_velocity_clipped)
        angular_velocity[row] = s.angular_velocity - model.angular_velocity;
      if (s.has_acceleration) force[row] = s.acceleration - model.force;
    }
    angular_velocity = smoothed(time, angular_velocity, width);
    force = smoothed(time, force, width);
    InsSensor result = sensor;
    for (std::size_t row = 0; row < time.size(); ++row) {
      if (!angular_velocity[row].allFinite() && !force[row].allFinite()) continue;
      const PredictedMeasurement model = at(slow, index, time[row]);
      put(result.angular_velocity, row, model.angular_velocity + angular_velocity[row]);
      put(result.acceleration, row, model.force + force[row]);
    }
    return result;
  }
};

}  // namespace

double gaussian_width(double cutoff) {
  return std::sqrt(std::numbers::ln2) / (2.0 * std::numbers::pi * cutoff);
}

MatrixXd low_frequency_motion(ConstMatrixRef coefficients, const SplineGrid& grid, double cutoff) {
  // Filtering the coefficients filters the spline: it is a sum of the same basis function shifted by whole periods.
  const double width = gaussian_width(cutoff) / grid.period;
  const auto half = static_cast<Index>(std::ceil(kernel_reach * width));
  MatrixXd result(coefficients.rows(), coefficients.cols());
  for (Index k = 0; k < coefficients.cols(); ++k) {
    VectorXd sum = VectorXd::Zero(coefficients.rows());
    double weights = 0.0;
    for (Index i = std::max<Index>(0, k - half); i <= std::min(coefficients.cols() - 1, k + half); ++i) {
      const double w = weight(static_cast<double>(i - k), width);
      sum += w * coefficients.col(i);
      weights += w;
    }
    result.col(k) = sum / weights;
  }
  return result;
}

InsRecording low_frequency_measurements(const InsRecording& recording, const InsProblem& problem, const InsUnknowns& x,
                                        double cutoff, int threads) {
  InsUnknowns slow = x;
  slow.spline_coefficients = low_frequency_motion(x.spline_coefficients, problem.grid, cutoff);
  const LowFrequencyMachine machine{
      problem, x, slow, layout_of(problem, x.bodies), bodies_of(x), gaussian_width(cutoff)};
  InsRecording result = recording;
  parallel_for(recording.sensors.size(), threads, [&](std::size_t i) {
    const InsSensor& sensor = recording.sensors[i];
    result.sensors[i] = machine.low_frequency_sensor(sensor, i, recording.time(sensor));
  });
  return result;
}

}  // namespace kinfer
