// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/statistics.hpp"

#include <math.h>  // lgamma_r of POSIX

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// ln Γ(x), x > 0. std::lgamma writes a global variable, which threads must not.
double log_gamma(double x) {
  int sign = 1;
  return ::lgamma_r(x, &sign);
}

/// Σ zᵏ / (a (a + 1) ... (a + k)), the lower incomplete gamma function divided by zᵃ e⁻ᶻ; for z < a + 1.
double gamma_series(double a, double z) {
  double term = 1.0 / a, sum = term;
  for (double k = 1.0; term > 1e-17 * sum; ++k) {
    term *= z / (a + k);
    sum += term;
  }
  return sum;
}

/// The upper incomplete gamma function divided by zᵃ e⁻ᶻ, by Lentz's continued fraction; for z > a + 1.
double gamma_fraction(double a, double z) {
  double b = z + 1.0 - a, c = 1e300, d = 1.0 / b, value = d;
  for (int k = 1; k < 100000; ++k) {
    const double numerator = -k * (k - a);
    b += 2.0;
    d = 1.0 / (numerator * d + b);
    c = b + numerator / c;
    value *= c * d;
    if (std::abs(c * d - 1.0) < 1e-16) break;
  }
  return value;
}

/// a B(a, b) / (xᵃ (1 − x)ᵇ) times the regularised incomplete beta function of x, by the modified Lentz method; for
/// x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1.0, d = 1.0 / (1.0 - (a + b) * x / (a + 1.0)), value = d;
  const auto step = [&](double numerator) {
    d = 1.0 / (1.0 + numerator * d);
    c = 1.0 + numerator / c;
    value *= c * d;
    return std::abs(c * d - 1.0);
  };
  for (int m = 1; m < 100000; ++m) {
    step(m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)));
    if (step(-(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))) < 1e-16) break;
  }
  return value;
}

/// For x in (0, 1).
double regularised_beta(double x, double a, double b) {
  const double factor = std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? factor * beta_fraction(a, b, x) / a
                                       : 1.0 - factor * beta_fraction(b, a, 1.0 - x) / b;
}

}  // namespace

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
  const double rank = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(rank);
  const auto at = values.begin() + below;
  std::nth_element(values.begin(), at, values.end());
  const double next = at + 1 < values.end() ? *std::min_element(at + 1, values.end()) : *at;
  return *at + (rank - static_cast<double>(below)) * (next - *at);
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

double robust_sd(std::vector<double> values) {
  const double center = median(values);
  for (double& v : values) v = std::abs(v - center);
  return 1.4826 * median(std::move(values));
}

double log_sum(std::span<const double> logarithms) {
  const double largest = *std::ranges::max_element(logarithms);
  double sum = 0.0;
  for (const double log : logarithms) sum += std::exp(log - largest);
  return largest + std::log(sum);
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double p) {
  KINFER_EXPECT(p > 0.0 && p < 1.0, "p = {}", p);
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 200 && high - low > 1e-15 * (1.0 + std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double chi_squared_cdf(double x, double n) {
  KINFER_EXPECT(n > 0.0, "{} degrees of freedom", n);
  if (x <= 0.0) return 0.0;
  const double a = 0.5 * n, z = 0.5 * x;
  const double factor = std::exp(a * std::log(z) - z - log_gamma(a));
  return z < a + 1.0 ? factor * gamma_series(a, z) : 1.0 - factor * gamma_fraction(a, z);
}

double chi_squared_quantile(double p, double n) {
  KINFER_EXPECT(p > 0.0 && p < 1.0, "p = {}", p);
  double low = 0.0, high = n;
  while (chi_squared_cdf(high, n) < p) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi_squared_cdf(middle, n) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double f_cdf(double x, double n1, double n2) {
  KINFER_EXPECT(n1 > 0.0 && n2 > 0.0, "{} and {} degrees of freedom", n1, n2);
  return x <= 0.0 ? 0.0 : regularised_beta(n1 * x / (n1 * x + n2), 0.5 * n1, 0.5 * n2);
}

double f_quantile(double p, double n1, double n2) {
  KINFER_EXPECT(p > 0.0 && p < 1.0, "p = {}", p);
  double low = 0.0, high = 1.0;
  while (f_cdf(high, n1, n2) < p) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (f_cdf(middle, n1, n2) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double effective_samples(std::span<const double> series) {
  double mean = 0.0, square = 0.0, product = 0.0;
  for (const double x : series) mean += x / static_cast<double>(series.size());
  for (std::size_t i = 0; i < series.size(); ++i) {
    square += (series[i] - mean) * (series[i] - mean);
    if (i > 0) product += (series[i] - mean) * (series[i - 1] - mean);
  }
  const double r = square > 0.0 ? std::max(0.0, product / square) : 0.0;
  return std::max(1.0, static_cast<double>(series.size()) * (1.0 - r) / (1.0 + r));
}

}  // namespace kinfer
