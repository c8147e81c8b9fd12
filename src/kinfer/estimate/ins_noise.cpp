#include "kinfer/estimate/ins_noise.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

/// Mean product of offsets `lag` intervals apart.
double covariance(const std::vector<std::array<float, 3>>& offset, std::size_t axis, std::size_t lag) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = lag; i < offset.size(); ++i) {
    const double product = double{offset[i][axis]} * double{offset[i - lag][axis]};
    if (!std::isfinite(product)) continue;
    sum += product;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

double memory_of_axis(const std::vector<std::array<float, 3>>& offset, std::size_t axis) {
  const double variance = covariance(offset, axis, 0);
  double memory = 1.0;
  for (std::size_t lag = 1; variance > 0.0 && lag < offset.size() / 10; ++lag) {
    const double rho = covariance(offset, axis, lag) / variance;
    if (rho <= 0.0) break;
    memory += 2.0 * rho;
  }
  return memory;
}

/// Mean of the blocks' squares over terms without the largest twentieth: spikes and collisions.
double trimmed_mean(const InstrumentFit& fit) {
  std::vector<float> values;
  for (const float value : fit.block)
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return 0.0;
  const auto kept = values.begin() + static_cast<std::ptrdiff_t>(values.size() - values.size() / 20);
  std::nth_element(values.begin(), kept - 1, values.end());
  double sum = 0.0;
  for (auto value = values.begin(); value != kept; ++value) sum += *value;
  return sum / static_cast<double>(kept - values.begin());
}

/// Noise over the least noise of each sensor as the residuals show it, kept near what is usual among the sensors: else
/// a fit may buy one sensor's perfection with another's neglect.
std::vector<double> believed(std::vector<double> shown) {
  constexpr double near = 1.5;
  const double usual = shown.empty() ? 1.0 : median(shown);
  for (double& factor : shown) factor = std::max(1.0, std::clamp(factor, usual / near, usual * near));
  return shown;
}

/// Of one instrument of all sensors, where `noise` stands in a sensor's noise and `fit` among its fits.
void show(std::vector<InsNoise>& all, const InsProblem& problem, const InsCost& cost, double InsNoise::*noise,
          InstrumentFit SensorFit::*fit) {
  std::vector<double> shown;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s)
    shown.push_back(problem.sensors[s].noise.*noise / problem.sensors[s].least.*noise *
                    std::sqrt(trimmed_mean(cost.sensors[s].*fit)));
  const std::vector<double> factors = believed(shown);
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) all[s].*noise = factors[s] * problem.sensors[s].least.*noise;
}

/// Magnetometers: only ever less trust. Their memory is a rough figure, and a gauge need not be weighed finely.
void show_fields(std::vector<InsNoise>& all, const InsProblem& problem, const InsCost& cost) {
  constexpr double coarse = 2.0;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const InstrumentFit& field = cost.sensors[s].field;
    const double ratio = field.block.empty() ? 0.0 : trimmed_mean(field) * memory_of(field);
    all[s].field = problem.sensors[s].noise.field * (ratio > coarse ? std::sqrt(ratio) : 1.0);
  }
}

/// Of gyroscopes and accelerometers; the others as they are.
std::vector<InsNoise> shown_noise(const InsProblem& problem, const InsCost& cost) {
  std::vector<InsNoise> shown;
  for (const InsReadings& readings : problem.sensors) shown.push_back(readings.noise);
  show(shown, problem, cost, &InsNoise::rate, &SensorFit::rate);
  show(shown, problem, cost, &InsNoise::force, &SensorFit::force);
  return shown;
}

bool differ(const InsProblem& problem, const std::vector<InsNoise>& shown) {
  constexpr double notable = 0.05;
  const auto differs = [](double a, double b) { return std::abs(b - a) > notable * a; };
  for (std::size_t s = 0; s < shown.size(); ++s) {
    const InsNoise& noise = problem.sensors[s].noise;
    if (differs(noise.rate, shown[s].rate) || differs(noise.force, shown[s].force) ||
        differs(noise.field, shown[s].field))
      return true;
  }
  return false;
}

}  // namespace

double memory_of(const InstrumentFit& fit) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += memory_of_axis(fit.offset, axis) / 3.0;
  return sum;
}

bool is_stale(const InsProblem& problem, const InsCost& cost) {
  return differ(problem, shown_noise(problem, cost));
}

bool reweigh(InsProblem& problem, const InsCost& cost) {
  std::vector<InsNoise> shown = shown_noise(problem, cost);
  show_fields(shown, problem, cost);
  const bool changed = differ(problem, shown);
  for (std::size_t s = 0; s < shown.size(); ++s) problem.sensors[s].noise = shown[s];
  return changed;
}

}  // namespace kinfer
