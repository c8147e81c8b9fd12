// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/estimate/continuous/solver/noise_information.hpp"
#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr Index scale_terms = 9;                                // of one instrument
constexpr Index gyroscope_scale = 6, accelerometer_scale = 15;  // among the unknowns of a sensor (InsLayout)

/// Gives the problem another noise, in this object's scope.
class ScopedNoise {
 public:
  ScopedNoise(InsProblem& problem, std::vector<InsNoise> noise) : problem_(problem), noise_(std::move(noise)) {
    exchange();
  }
  ScopedNoise(const ScopedNoise&) = delete;
  ScopedNoise& operator=(const ScopedNoise&) = delete;
  ~ScopedNoise() { exchange(); }

 private:
  void exchange() {
    for (std::size_t s = 0; s < noise_.size(); ++s) std::swap(problem_.sensors[s].noise, noise_[s]);
  }

  InsProblem& problem_;
  std::vector<InsNoise> noise_;
};

bool exceed(const std::vector<InsNoise>& noise, const InsProblem& problem) {
  for (std::size_t s = 0; s < noise.size(); ++s)
    if (noise[s].angular_velocity > problem.sensors[s].noise.angular_velocity ||
        noise[s].force > problem.sensors[s].noise.force)
      return true;
  return false;
}

/// Mean measurement of a block; empty if it has none.
std::optional<Vec3> block_mean(const InsBlock& block) {
  const Eigen::Matrix<double, block_nodes, 1> by_offset = block.factor.cast<double>().rowwise().sum();
  const double squares = by_offset.squaredNorm();
  if (block.samples == 0 || squares <= 0.0) return std::nullopt;
  return Vec3(block.target.cast<double>().transpose() * by_offset / squares);
}

/// Of the intervals' means: rms distance from their mean, its square along each axis, and samples per interval.
struct SignalSize {
  double rms = 0.0;
  Vec3 variance = Vec3::Zero();
  double samples = 0.0;
};

SignalSize signal_size(const std::vector<InsBlock>& blocks) {
  Vec3 sum = Vec3::Zero(), squares_along = Vec3::Zero();
  double squares = 0.0, count = 0.0, samples = 0.0;
  for (const InsBlock& block : blocks)
    if (const auto value = block_mean(block)) {
      sum += *value;
      squares += value->squaredNorm();
      squares_along += value->cwiseAbs2();
      samples += block.samples;
      count += 1.0;
    }
  if (count <= 0.0) return {};
  return {std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm())),
          squares_along / count - (sum / count).cwiseAbs2(), samples / count};
}

/// Size of the elements of an instrument's considered E. `axes`: those in which its errors show.
double considered_scale(const std::vector<InsBlock>& blocks, const InstrumentFit& fit, double sd, double axes) {
  const SignalSize signal = signal_size(blocks);
  if (signal.rms <= 0.0) return 0.0;
  const double persistent = sd * std::sqrt(persistent_variance(fit) / axes / signal.samples);
  return std::min(max_considered_scale, considered_over_persistent * persistent / signal.rms);
}

/// Adds the effect of errors in some global parameters that are as large as `scale`, beyond what the prior allows.
void add_considered(MatrixXd& covariance, const MatrixXd& gain, Index first, double scale) {
  if (scale <= 0.0) return;
  const MatrixXd shift = scale * gain.middleCols(first, scale_terms);
  covariance += times_transposed(shift, shift);
}

}  // namespace

std::optional<InsCovariance> covariance_with_model_error(InsProblem& problem, const InsLayout& layout,
                                                         const InsUnknowns& x, const InsCost& cost,
                                                         const AssumedScale& assumed, int threads) {
  const InsSystem system(problem, layout, x, {}, threads);
  const auto white = covariance_of(system);
  if (!white) return std::nullopt;
  InsCovariance result = *white;
  if (std::vector<InsNoise> noise = long_run_noise(problem, cost); exceed(noise, problem)) {
    const ScopedNoise scope(problem, std::move(noise));
    const auto correlated = model_covariance(InsSystem(problem, layout, x, {}, threads));
    if (!correlated) return std::nullopt;
    result.model = correlated->model;
  }
  discount(result.model, white->model, global_parameter_prior(problem, layout, x).matrix,
           noise_information(problem, layout, x, threads));
  if (layout.has_matrices) {
    const MatrixXd data = system.schur() - global_parameter_prior(problem, layout, x).matrix,
                   gain = product(white->model, data);  // step of the estimate for an error in a parameter
    const std::vector<ConsideredScale> considered = considered_scales(problem, cost);
    for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
      add_considered(result.model, gain, layout.error[s] + gyroscope_scale,
                     std::hypot(considered[s].gyroscope, assumed.gyroscope));
      add_considered(result.model, gain, layout.error[s] + accelerometer_scale,
                     std::hypot(considered[s].accelerometer, assumed.accelerometer));
    }
  }
  result.inflation = white->inflation.array() * white->model.diagonal().array() / result.model.diagonal().array();
  return result;
}

std::vector<ConsideredScale> considered_scales(const InsProblem& problem, const InsCost& cost) {
  constexpr double rate_axes = 2.0, force_axes = 3.0;  // a joint's position absorbs the rate about its axis
  std::vector<ConsideredScale> considered;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const InsMeasurements& r = problem.sensors[s];
    const SensorFit& fit = cost.sensors[s];
    considered.push_back(
        {considered_scale(r.angular_velocity, fit.angular_velocity, r.noise.angular_velocity, rate_axes),
         considered_scale(r.force, fit.force, r.noise.force, force_axes)});
  }
  return considered;
}

Vec3 regression_dilution(const std::vector<InsBlock>& blocks, double noise) {
  const SignalSize measured = signal_size(blocks);
  if (measured.samples <= 0.0) return Vec3::Ones();
  const double of_noise = noise * noise / measured.samples;
  return measured.variance.unaryExpr(
      [&](double variance) { return variance > 2.0 * of_noise ? of_noise / (variance - of_noise) : 1.0; });
}

std::optional<LongRunEstimate> long_run_estimate(InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                                 const InsCost& cost, int threads) {
  const ScopedNoise scope(problem, long_run_noise(problem, cost));
  const InsSystem system(problem, layout, x, {}, threads);
  const auto step = system.solve();
  const auto covariance = model_covariance(system);
  if (!step || !covariance) return std::nullopt;
  return LongRunEstimate{step->border, covariance->model};
}

}  // namespace kinfer
