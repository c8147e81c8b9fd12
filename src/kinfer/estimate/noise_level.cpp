#include "kinfer/estimate/noise_level.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

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

double excess_of(const std::vector<Vec3>& residuals, const std::vector<Vec3>& sd, int size, double absorbed) {
  if (residuals.empty()) return 0.0;
  double largest = 0.0;
  for (const Vec3& r : residuals) largest = std::max(largest, r.norm());
  const auto median_norm2 = [&](double excess) {
    std::vector<double> norm2(residuals.size());
    for (std::size_t i = 0; i < residuals.size(); ++i)
      norm2[i] = residuals[i].cwiseAbs2().cwiseQuotient((sd[i].cwiseAbs2().array() + excess * excess).matrix()).sum();
    return median(std::move(norm2));
  };
  return solve_excess(median_norm2, chi_squared_quantile(0.5, size) * absorbed, 2.0 * largest);
}

/// The kind's blocks in natural units, padded with zeros to three numbers.
std::vector<Vec3> residuals_of(const ResidualKind& kind, const Scene& scene) {
  std::vector<Vec3> residuals(kind.count(scene.data), Vec3::Zero());
  VectorXd rows = VectorXd::Zero(3);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    BlockRows out{rows, nullptr, 0};
    kind.write(scene, i, out);
    residuals[i].head(kind.size) = rows.head(kind.size);
  }
  return residuals;
}

}  // namespace

ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double effective_parameters) {
  const ParameterSet nothing;
  const EvaluatedPoses at = evaluate_poses(chain, nothing, data, Derivative::no);
  const ColumnsOfSurroundings columns = columns_of_surroundings(chain, nothing);
  const Scene scene{chain, data, at, columns};
  double rows = 0.0;
  for (const ResidualKind& kind : residual_kinds()) rows += kind.size * static_cast<double>(kind.count(data));
  // Each determined parameter takes one residual away; a tenth is left even where hardly any redundancy is.
  const double left = std::max(0.1, 1.0 - effective_parameters / rows);
  const Weights promised = weights_of(data, instrument.value_or(Instrument{}));
  ExcessNoise excess;
  for (const ResidualKind& kind : residual_kinds())
    excess.of[static_cast<std::size_t>(kind.kind)] =
        excess_of(residuals_of(kind, scene), promised.of(kind.kind), kind.size, left);
  return excess;
}

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  Weights weights = weights_of(data, instrument.value_or(Instrument{}));
  for (const ResidualKind& kind : residual_kinds()) {
    const double more = excess.of[static_cast<std::size_t>(kind.kind)];
    for (Vec3& sd : weights.of(kind.kind)) sd = (sd.cwiseAbs2().array() + more * more).sqrt();
  }
  return weights;
}

}  // namespace kinfer
