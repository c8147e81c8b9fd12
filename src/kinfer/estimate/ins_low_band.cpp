#include "kinfer/estimate/ins_low_band.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/ins_motion.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
constexpr double reach = 4.0;  // [standard deviations] of the kernel

double weight(double distance, double width) {
  const double z = distance / width;
  return std::exp(-0.5 * z * z);
}

/// What one sensor's instruments say at one row, or would say.
struct Said {
  Vec3 rate, force;
};

Said said_by(const InsState& state, const InsErrors& errors) {
  return {state.rate + errors.rate_matrix * state.rate + errors.rate_bias,
          state.force + errors.force_matrix * state.force + errors.force_bias};
}

/// Body that carries each sensor.
std::vector<std::size_t> bodies_of(const InsUnknowns& x) {
  std::vector<std::size_t> bodies(x.errors.size(), 0);
  for (std::size_t b = 0; b < x.bodies.size(); ++b)
    if (x.bodies[b].sensor >= 0) bodies[static_cast<std::size_t>(x.bodies[b].sensor)] = b;
  return bodies;
}

/// L over rows that have a value (finite); NaN elsewhere.
std::vector<Vec3> smoothed(std::span<const double> time, const std::vector<Vec3>& values, double width) {
  std::vector<Vec3> result = values;
  std::size_t first = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!values[row].allFinite()) continue;
    while (time[row] - time[first] > reach * width) ++first;
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (std::size_t i = first; i < values.size() && time[i] - time[row] <= reach * width; ++i) {
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

/// One recording's sensor after the other through the same motion.
struct SlowMachine {
  const InsProblem& problem;
  const InsUnknowns &fast, &slow;
  InsLayout layout;
  std::vector<std::size_t> body;
  double width;

  Said at(const InsUnknowns& x, std::size_t sensor, double time) const {
    const auto [interval, u] = problem.grid.place(time);
    const auto states = body_states(problem, layout, x, interval, spline_basis(u, problem.grid.period));
    return said_by(states[body[sensor]], x.errors[sensor]);
  }

  InsSensor slowed(const InsSensor& sensor, std::size_t index, std::span<const double> time) const {
    const Vec3 nothing = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<Vec3> rate(time.size(), nothing), force(time.size(), nothing);
    for (std::size_t row = 0; row < time.size(); ++row) {
      const InsSample s = sample(sensor, time, row);
      if (!s.has_rate && !s.has_acceleration) continue;
      const Said model = at(fast, index, time[row]);
      if (s.has_rate && !s.rate_clipped) rate[row] = s.rate - model.rate;
      if (s.has_acceleration) force[row] = s.acceleration - model.force;
    }
    rate = smoothed(time, rate, width);
    force = smoothed(time, force, width);
    InsSensor result = sensor;
    for (std::size_t row = 0; row < time.size(); ++row) {
      if (!rate[row].allFinite() && !force[row].allFinite()) continue;
      const Said model = at(slow, index, time[row]);
      put(result.rate, row, model.rate + rate[row]);
      put(result.acceleration, row, model.force + force[row]);
    }
    return result;
  }
};

}  // namespace

double gaussian_width(double cutoff) {
  return std::sqrt(std::numbers::ln2) / (2.0 * std::numbers::pi * cutoff);
}

MatrixXd low_band(ConstMatrixRef band, const SplineGrid& grid, double cutoff) {
  // A filter of the coefficients filters the spline: both are sums of the same shape moved by whole periods.
  const double width = gaussian_width(cutoff) / grid.period;
  const auto half = static_cast<Index>(std::ceil(reach * width));
  MatrixXd result(band.rows(), band.cols());
  for (Index k = 0; k < band.cols(); ++k) {
    VectorXd sum = VectorXd::Zero(band.rows());
    double weights = 0.0;
    for (Index i = std::max<Index>(0, k - half); i <= std::min(band.cols() - 1, k + half); ++i) {
      const double w = weight(static_cast<double>(i - k), width);
      sum += w * band.col(i);
      weights += w;
    }
    result.col(k) = sum / weights;
  }
  return result;
}

InsRecording low_band_readings(const InsRecording& recording, const InsProblem& problem, const InsUnknowns& x,
                               double cutoff, int threads) {
  InsUnknowns slow = x;
  slow.band = low_band(x.band, problem.grid, cutoff);
  const SlowMachine machine{problem, x, slow, layout_of(problem, x.bodies), bodies_of(x), gaussian_width(cutoff)};
  InsRecording result = recording;
  parallel_for(recording.sensors.size(), threads, [&](std::size_t i) {
    const InsSensor& sensor = recording.sensors[i];
    result.sensors[i] = machine.slowed(sensor, i, recording.time(sensor));
  });
  return result;
}

}  // namespace kinfer
