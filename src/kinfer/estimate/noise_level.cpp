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

/// One kind's blocks with the deviations that they are measured against, along the same axes.
struct Blocks {
  std::vector<Vec3> residuals, sd;
};

RemainingError in_world(const Blocks& blocks, int index, const std::optional<Mat3>& axes) {
  const Vec3& along = blocks.residuals[index];
  return {axes ? Vec3(*axes * along) : along, covariance_of(blocks.sd[index], axes)};
}

void replace(Blocks& blocks, int index, const RemainingError& by) {
  const PrincipalDeviations spread = principal_deviations(by.covariance);
  blocks.residuals[index] = spread.axes.transpose() * by.error, blocks.sd[index] = spread.sd;
}

/// Points and orientations that err together hide small errors in each other's: points are judged given the
/// orientation, and orientations given the point with the excess that was found for it.
void judge_poses(const Weights& promised, const PoseSet& data, double left, Blocks& points, Blocks& turns,
                 ExcessNoise& excess) {
  Blocks given_turns = points;
  for (const PoseCoupling& c : promised.couplings) {
    const OrientationMeasurement& turn = data.orientations[c.orientation];
    replace(given_turns, c.point,
            given(in_world(turns, c.orientation, turn.axes), in_world(points, c.point, data.points[c.point].axes),
                  *turn.with_point));
  }
  double& of_points = excess.of[static_cast<std::size_t>(MeasurementKind::point)];
  of_points = excess_of(given_turns.residuals, given_turns.sd, 3, left);
  for (const PoseCoupling& c : promised.couplings) {
    const OrientationMeasurement& turn = data.orientations[c.orientation];
    RemainingError point = in_world(points, c.point, data.points[c.point].axes);
    point.covariance += of_points * of_points * Mat3::Identity();
    replace(turns, c.orientation,
            given(point, in_world(turns, c.orientation, turn.axes), turn.with_point->transpose()));
  }
  excess.of[static_cast<std::size_t>(MeasurementKind::orientation)] = excess_of(turns.residuals, turns.sd, 3, left);
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
  std::array<Blocks, measurement_kinds> blocks;
  for (const ResidualKind& kind : residual_kinds()) {
    const auto k = static_cast<std::size_t>(kind.kind);
    blocks[k] = {residuals_of(kind, scene), promised.of(kind.kind)};
    excess.of[k] = excess_of(blocks[k].residuals, blocks[k].sd, kind.size, left);
  }
  if (!promised.couplings.empty())
    judge_poses(promised, data, left, blocks[static_cast<std::size_t>(MeasurementKind::point)],
                blocks[static_cast<std::size_t>(MeasurementKind::orientation)], excess);
  return excess;
}

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  Weights weights = weights_of(data, instrument.value_or(Instrument{}));
  for (const ResidualKind& kind : residual_kinds()) {
    const double more = excess.of[static_cast<std::size_t>(kind.kind)];
    for (Vec3& sd : weights.of(kind.kind)) sd = (sd.cwiseAbs2().array() + more * more).sqrt();
  }
  weights.couplings = couplings_of(data, weights.point_sd, weights.orientation_sd);
  return weights;
}

}  // namespace kinfer
