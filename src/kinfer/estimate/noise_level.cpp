#include "kinfer/estimate/noise_level.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double median_chi2_of_three = 2.36597;  // of a chi-squared variable with 3 degrees of freedom

/// Excess that brings the median of block norms² (given an excess) down to that of Gaussian noise; 0 if it is there
/// already.
double solve_excess(const std::function<double(double)>& median_norm2, double target, double upper) {
  if (median_norm2(0.0) <= target) return 0.0;
  double low = 0.0, high = upper;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (median_norm2(middle) > target ? low : high) = middle;
  }
  return high;
}

std::vector<Vec3> point_residuals(const Chain& chain, const PoseSet& data) {
  Weights unit;
  unit.point_sd.assign(data.points.size(), Vec3::Ones());
  unit.orientation_sd.assign(data.orientations.size(), 1.0);
  VectorXd r;
  const ParameterSet nothing;
  pose_residuals(chain, nothing, data, unit).evaluate(VectorXd(0), r, nullptr);
  std::vector<Vec3> blocks;
  for (Eigen::Index i = 0; i + 2 < r.size(); i += 3) blocks.push_back(r.segment<3>(i));
  return blocks;
}

double excess_of(const std::vector<Vec3>& residuals, const std::vector<Vec3>& sd, double absorbed) {
  if (residuals.empty()) return 0.0;
  double largest = 0.0;
  for (const Vec3& r : residuals) largest = std::max(largest, r.norm());
  const auto median_norm2 = [&](double excess) {
    std::vector<double> norm2(residuals.size());
    for (std::size_t i = 0; i < residuals.size(); ++i)
      norm2[i] = residuals[i].cwiseAbs2().cwiseQuotient((sd[i].cwiseAbs2().array() + excess * excess).matrix()).sum();
    return median(std::move(norm2));
  };
  return solve_excess(median_norm2, median_chi2_of_three * absorbed, 2.0 * largest);
}

}  // namespace

ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double effective_parameters) {
  const std::vector<Vec3> all = point_residuals(chain, data);
  const auto points = static_cast<std::ptrdiff_t>(data.points.size());
  const std::vector<Vec3> positions(all.begin(), all.begin() + points), turns(all.begin() + points, all.end());
  const double rows = 3.0 * static_cast<double>(all.size());
  // Each determined parameter takes one residual away; a tenth is left even where hardly any redundancy is.
  const double left = std::max(0.1, 1.0 - effective_parameters / rows);

  const Weights promised = weights_of(data, instrument.value_or(Instrument{}));
  std::vector<Vec3> turn_sd;
  for (const double sd : promised.orientation_sd) turn_sd.push_back(Vec3::Constant(sd));
  return {excess_of(positions, promised.point_sd, left), excess_of(turns, turn_sd, left)};
}

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  Weights weights = weights_of(data, instrument.value_or(Instrument{}));
  for (Vec3& sd : weights.point_sd) sd = (sd.cwiseAbs2().array() + excess.position * excess.position).sqrt();
  for (double& sd : weights.orientation_sd) sd = std::hypot(sd, excess.orientation);
  return weights;
}

}  // namespace kinfer
