#include "kinfer/geometry/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {

double mean(std::span<const double> values) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double rms(std::span<const double> values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

double standard_deviation(std::span<const double> values) {
  if (values.size() < 2) return 0.0;
  const double m = mean(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - m) * (v - m);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double quantile(std::vector<double> values, double fraction) {
  KINFER_EXPECT(!values.empty() && fraction >= 0.0 && fraction <= 1.0);
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double robust_sd(std::vector<double> values) {
  const double center = median(values);
  for (double& v : values) v = std::abs(v - center);
  return 1.4826 * median(std::move(values));
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double p) {
  KINFER_EXPECT(p > 0.0 && p < 1.0, "p = {}", p);
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 200 && high - low > 1e-15 * (1.0 + std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double chi_squared_quantile(double p, double n) {
  const double spread = 2.0 / (9.0 * n);
  return n * std::pow(1.0 - spread + normal_quantile(p) * std::sqrt(spread), 3);
}

}  // namespace kinfer
