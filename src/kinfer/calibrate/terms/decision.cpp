// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/decision.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

QuantileChange compare_quantile(const std::vector<double>& before, const std::vector<double>& after, double fraction) {
  QuantileChange change{quantile(before, fraction), quantile(after, fraction), 0.0};
  if (change.after <= thresholds::tail_ratio * change.before) return change;
  const Rng rng(1);
  std::vector<double> a(before.size()), b(before.size());
  int rises = 0;
  for (int draw = 0; draw < thresholds::bootstrap_draws; ++draw) {
    Rng rows = rng.stream(draw);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const std::uint64_t row = rows.index(before.size());
      a[i] = before[row], b[i] = after[row];
    }
    rises += quantile(b, fraction) > quantile(a, fraction);
  }
  change.rise_probability = static_cast<double>(rises) / thresholds::bootstrap_draws;
  return change;
}

bool mean_rises(const ErrorChange& change) {
  return change.mean_after > change.mean_before && change.t < -thresholds::harm_significance;
}

bool rises(const QuantileChange& change) {
  return change.rise_probability > thresholds::harm_probability;
}

bool tail_rises(const ErrorChange& change) {
  return rises(change.p95) || rises(change.p99);
}

double expected(double inside, double outside) {
  return (1.0 - thresholds::part_beyond) * inside + thresholds::part_beyond * outside;
}

/// The mean reduction over its standard error, of poses among the fitted ones and beyond them as expected.
double t_of_expected(const ErrorChange& inside, const ErrorChange& outside) {
  const auto reduction = [](const ErrorChange& change) { return change.mean_before - change.mean_after; };
  const auto error = [&](const ErrorChange& change) { return change.t == 0.0 ? 0.0 : reduction(change) / change.t; };
  const double variance = std::pow((1.0 - thresholds::part_beyond) * error(inside), 2) +
                          std::pow(thresholds::part_beyond * error(outside), 2);
  return expected(reduction(inside), reduction(outside)) / (std::sqrt(variance) + 1e-300);
}

/// Whether what is lost beyond the fitted poses is more than what is gained among them, in the mean or in the 99 %
/// point of all poses.
bool outweighs_gain(const ErrorChange& inside, const ErrorChange& outside) {
  return t_of_expected(inside, outside) < -thresholds::harm_significance ||
         (rises(outside.p99) &&
          expected(inside.p99.after, outside.p99.after) > expected(inside.p99.before, outside.p99.before));
}

}  // namespace

ErrorChange compare_errors(std::span<const double> before, std::span<const double> after) {
  KINFER_EXPECT(before.size() == after.size(), "{} and {} errors", before.size(), after.size());
  ErrorChange change;
  if (before.size() < 2) return change;
  std::vector<double> reduction;
  for (std::size_t i = 0; i < before.size(); ++i) reduction.push_back(before[i] - after[i]);
  change.mean_before = mean(before), change.mean_after = mean(after);
  change.worst_before = *std::ranges::max_element(before), change.worst_after = *std::ranges::max_element(after);
  const double standard_error = standard_deviation(reduction) / std::sqrt(static_cast<double>(reduction.size()));
  change.t = mean(reduction) / (standard_error + 1e-300);
  const std::vector<double> a(before.begin(), before.end()), b(after.begin(), after.end());
  change.p95 = compare_quantile(a, b, 0.95), change.p99 = compare_quantile(a, b, 0.99);
  return change;
}

Decision decide(const ErrorChange& interpolation, const ErrorChange& extrapolation) {
  if (mean_rises(interpolation)) return Decision::no_improvement;
  if (tail_rises(interpolation)) return Decision::tail_rises;
  return outweighs_gain(interpolation, extrapolation) ? Decision::extrapolation_worse : Decision::accepted;
}

}  // namespace kinfer::calibrate
