// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer::report {

std::vector<double> finite_sorted(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  return values;
}

double quantile(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(sorted.size() - 1)));
  return sorted[std::min(k, sorted.size() - 1)];
}

double round_down(double value) {
  const double at_least_one = std::max(value, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(at_least_one))), digit = at_least_one / power;
  return power * (digit >= 5.0 ? 5.0 : digit >= 2.0 ? 2.0 : 1.0);
}

}  // namespace kinfer::report
