// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/noise_level.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

/// Excess noise at which the median of the squared block norms equals that of Gaussian noise; 0 if it is below already.
/// By bisection.
double solve_excess(const std::function<double(double)>& median_norm2, double target, double upper) {
  if (median_norm2(0.0) <= target) return 0.0;
  double low = 0.0, high = upper;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (median_norm2(middle) > target ? low : high) = middle;
  }
  return high;
}

/// For blocks that all have the same standard deviation along every axis.
double excess_over(double sd, const std::vector<Vec3>& residuals, double target) {
  std::vector<double> norm2;
  for (const Vec3& r : residuals) norm2.push_back(r.squaredNorm());
  return std::sqrt(std::max(0.0, median(std::move(norm2)) / target - sd * sd));
}

double excess_of(const std::vector<Vec3>& residuals, const std::vector<Vec3>& sd, int size, double absorbed) {
  if (residuals.empty()) return 0.0;
  const double target = chi_squared_quantile(0.5, size) * absorbed, first = sd.front()[0];
  if (std::ranges::all_of(sd, [&](const Vec3& s) { return s == Vec3::Constant(first); }))
    return excess_over(first, residuals, target);
  double largest = 0.0;
  for (const Vec3& r : residuals) largest = std::max(largest, r.norm());
  const auto median_norm2 = [&](double excess) {
    std::vector<double> norm2(residuals.size());
    for (std::size_t i = 0; i < residuals.size(); ++i)
      norm2[i] = residuals[i].cwiseAbs2().cwiseQuotient((sd[i].cwiseAbs2().array() + excess * excess).matrix()).sum();
    return median(std::move(norm2));
  };
  return solve_excess(median_norm2, target, 2.0 * largest);
}

/// The kind's blocks in their own units, padded with zeros to three components.
std::vector<Vec3> residuals_of(const ResidualKind& kind, const ResidualContext& scene) {
  std::vector<Vec3> residuals(kind.count(scene.data), Vec3::Zero());
  VectorXd rows = VectorXd::Zero(3);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    BlockRows out{rows, nullptr, 0};
    kind.write(scene, i, out);
    residuals[i].head(kind.size) = rows.head(kind.size);
  }
  return residuals;
}

/// One kind's blocks with their standard deviations along the same axes.
struct Blocks {
  std::vector<Vec3> residuals, sd;
};

ConditionalError in_world(const Blocks& blocks, int index, const std::optional<Mat3>& axes) {
  const Vec3& along = blocks.residuals[index];
  return {axes ? Vec3(*axes * along) : along, covariance_of(blocks.sd[index], axes)};
}

void replace(Blocks& blocks, int index, const ConditionalError& by) {
  const PrincipalDeviations spread = principal_deviations(by.covariance);
  blocks.residuals[index] = spread.axes.transpose() * by.error, blocks.sd[index] = spread.sd;
}

/// With correlated points and orientations, each hides small errors behind the shared one: points are conditioned on
/// the orientation, then orientations on the point with the excess found for it.
void estimate_pose_noise(const Weights& specified, const PoseSet& data, const RedundancyOfKinds& redundancy,
                         Blocks& points, Blocks& turns, ExcessNoise& excess) {
  Blocks conditioned_points = points;
  for (const PoseCoupling& c : specified.couplings) {
    const OrientationMeasurement& turn = data.orientations[c.orientation];
    replace(conditioned_points, c.point,
            condition_on(in_world(turns, c.orientation, turn.axes),
                         in_world(points, c.point, data.points[c.point].axes), *turn.covariance_with_point));
  }
  double& of_points = excess.of[index(kind_of<PointMeasurement>)];
  of_points =
      excess_of(conditioned_points.residuals, conditioned_points.sd, 3, redundancy[index(kind_of<PointMeasurement>)]);
  for (const PoseCoupling& c : specified.couplings) {
    const OrientationMeasurement& turn = data.orientations[c.orientation];
    ConditionalError point = in_world(points, c.point, data.points[c.point].axes);
    point.covariance += of_points * of_points * Mat3::Identity();
    replace(turns, c.orientation,
            condition_on(point, in_world(turns, c.orientation, turn.axes), turn.covariance_with_point->transpose()));
  }
  excess.of[index(kind_of<OrientationMeasurement>)] =
      excess_of(turns.residuals, turns.sd, 3, redundancy[index(kind_of<OrientationMeasurement>)]);
}

}  // namespace

RedundancyOfKinds equal_redundancy(const PoseSet& data, double parameters) {
  double residuals = 0.0;
  for (const ResidualKind& kind : residual_kinds()) residuals += kind.size * static_cast<double>(kind.count(data));
  RedundancyOfKinds redundancy;
  redundancy.fill(std::max(0.1, 1.0 - parameters / std::max(1.0, residuals)));
  return redundancy;
}

ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         double parameters, int threads) {
  return excess_noise(chain, data, instrument, equal_redundancy(data, parameters), threads);
}

ExcessNoise excess_noise(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                         const RedundancyOfKinds& redundancy, int threads) {
  const ParameterSet nothing;
  const EvaluatedPoses at = evaluate_poses(chain, nothing, data, Derivative::no, threads);
  const FixtureColumns columns = fixture_columns(chain, nothing);
  return excess_noise({chain, data, at, columns}, instrument, redundancy);
}

ExcessNoise excess_noise(const ResidualContext& scene, const std::optional<Instrument>& instrument,
                         const RedundancyOfKinds& redundancy) {
  const PoseSet& data = scene.data;
  const Weights specified = weights_of(data, instrument.value_or(Instrument{}));
  ExcessNoise excess;
  std::array<Blocks, measurement_kinds> blocks;
  for (const ResidualKind& kind : residual_kinds()) {
    const auto k = index(kind.kind);
    blocks[k] = {residuals_of(kind, scene), specified.of(kind.kind)};
    excess.of[k] = excess_of(blocks[k].residuals, blocks[k].sd, kind.size, redundancy[k]);
  }
  const auto points = index(kind_of<PointMeasurement>), turns = index(kind_of<OrientationMeasurement>);
  if (!specified.couplings.empty())
    estimate_pose_noise(specified, data, redundancy, blocks[points], blocks[turns], excess);
  return excess;
}

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  Weights weights = weights_of(data, instrument.value_or(Instrument{}));
  for (const ResidualKind& kind : residual_kinds()) {
    const double more = excess.of[index(kind.kind)];
    for (Vec3& sd : weights.of(kind.kind)) sd = (sd.cwiseAbs2().array() + more * more).sqrt();
  }
  weights.couplings = couplings_of(data, weights.of<PointMeasurement>(), weights.of<OrientationMeasurement>());
  return weights;
}

double typical_sd(const Weights& weights, const ResidualKind& kind) {
  std::vector<double> sd;
  for (const Vec3& v : weights.of(kind.kind)) sd.push_back(v.head(kind.size).norm() / std::sqrt(kind.size));
  return sd.empty() ? 0.0 : rms(sd);
}

double typical_sd(const Weights& weights, bool (*accepts)(const MeasurementTraits&)) {
  for (const ResidualKind& kind : residual_kinds())
    if (accepts(kind.traits) && !weights.of(kind.kind).empty()) return typical_sd(weights, kind);
  return 0.0;
}

}  // namespace kinfer
