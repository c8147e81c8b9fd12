// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/noise_level.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double least_redundancy_of_all = 0.1;

/// Squared norm of a residual in units of its standard deviations with the excess.
double normalised_norm2(const Vec3& residual, const Vec3& sd, double excess) {
  return residual.cwiseAbs2().cwiseQuotient((sd.cwiseAbs2().array() + excess * excess).matrix()).sum();
}

/// The `rank`-th smallest of the excesses at which the blocks' squared norms equal `target`; 0 for a block that is
/// below already. By bisection of what holds it, in which only blocks that may still have that rank are evaluated.
double ranked_excess(const std::vector<Vec3>& residuals, const std::vector<Vec3>& sd, double target, std::size_t rank) {
  std::vector<std::size_t> undecided;
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!(normalised_norm2(residuals[i], sd[i], 0.0) > target)) continue;
    undecided.push_back(i);
    high = std::max(high, residuals[i].norm());
  }
  const std::size_t at_zero = residuals.size() - undecided.size();
  if (rank < at_zero) return 0.0;
  rank -= at_zero;
  high /= std::sqrt(target);
  for (double middle = 0.5 * high; middle > low && middle < high; middle = std::midpoint(low, high)) {
    const auto above = std::partition(undecided.begin(), undecided.end(), [&](std::size_t i) {
      return !(normalised_norm2(residuals[i], sd[i], middle) > target);
    });
    const auto below = static_cast<std::size_t>(above - undecided.begin());
    if (rank < below) {
      high = middle;
      undecided.erase(above, undecided.end());
    } else {
      low = middle, rank -= below;
      undecided.erase(undecided.begin(), above);
    }
  }
  return high;
}

/// For blocks that all have the same standard deviation along every axis.
double excess_over(double sd, const std::vector<Vec3>& residuals, double target) {
  std::vector<double> norm2;
  for (const Vec3& r : residuals) norm2.push_back(r.squaredNorm());
  return std::sqrt(std::max(0.0, median(std::move(norm2)) / target - sd * sd));
}

/// Excess noise at which the median of the squared block norms equals that of Gaussian noise; 0 if it is below already.
/// A norm falls with the excess, so that it is the median of the blocks' own excesses.
double excess_of(const std::vector<Vec3>& residuals, const std::vector<Vec3>& sd, int size, double absorbed) {
  if (residuals.empty()) return 0.0;
  const double target = chi_squared_quantile(0.5, size) * absorbed, first = sd.front()[0];
  if (std::ranges::all_of(sd, [&](const Vec3& s) { return s == Vec3::Constant(first); }))
    return excess_over(first, residuals, target);
  const std::size_t middle = residuals.size() / 2;
  const double upper = ranked_excess(residuals, sd, target, middle);
  return residuals.size() % 2 == 1 ? upper : std::midpoint(upper, ranked_excess(residuals, sd, target, middle - 1));
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

/// A residual in the world, where those of one pose can be compared; its variances along other axes are averaged.
void rotate_into_world(Vec3& residual, Vec3& sd, const std::optional<Mat3>& axes) {
  if (!axes) return;
  residual = (*axes * residual).eval();
  sd.setConstant(std::sqrt(sd.squaredNorm() / 3.0));
}

Blocks in_common_axes(MeasurementKind kind, Blocks blocks, const PoseSet& data) {
  const auto rotate = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i) rotate_into_world(blocks.residuals[i], blocks.sd[i], list[i].axes);
  };
  if (kind == kind_of<PointMeasurement>) rotate(data.points);
  if (kind == kind_of<OrientationMeasurement>) rotate(data.orientations);
  return blocks;
}

/// Mean of each group.
std::vector<Vec3> means_of_groups(const RepeatedMeasurements& repeated, const std::vector<Vec3>& values) {
  std::vector<Vec3> means(repeated.size.size(), Vec3::Zero());
  for (std::size_t i = 0; i < values.size(); ++i)
    means[static_cast<std::size_t>(repeated.group[i])] += values[i] / repeated.size_of(i);
  return means;
}

/// From their mean, as large as they would be from its expectation.
Blocks deviations_in_groups(const RepeatedMeasurements& repeated, const Blocks& blocks) {
  const std::vector<Vec3> means = means_of_groups(repeated, blocks.residuals);
  Blocks deviations;
  for (std::size_t i = 0; i < blocks.residuals.size(); ++i) {
    const double m = repeated.size_of(i);
    if (m < 2.0) continue;
    const Vec3 deviation = blocks.residuals[i] - means[static_cast<std::size_t>(repeated.group[i])];
    deviations.residuals.push_back(std::sqrt(m / (m - 1.0)) * deviation);
    deviations.sd.push_back(blocks.sd[i]);
  }
  return deviations;
}

/// With the variance that the measurements of each leave; `excess` beside the specified one.
Blocks group_means(const RepeatedMeasurements& repeated, const Blocks& blocks, double excess) {
  std::vector<Vec3> variances;
  for (const Vec3& sd : blocks.sd) variances.push_back(sd.cwiseAbs2().array() + excess * excess);
  Blocks means{means_of_groups(repeated, blocks.residuals), means_of_groups(repeated, variances)};
  for (std::size_t g = 0; g < means.sd.size(); ++g) means.sd[g] = (means.sd[g] / repeated.size[g]).cwiseSqrt();
  return means;
}

/// The parameters absorb the errors of poses, and next to nothing of what scatters within them.
double redundancy_of_poses(double redundancy, const RepeatedMeasurements& repeated) {
  const double absorbed = (1.0 - redundancy) * static_cast<double>(repeated.group.size());
  return std::max(least_redundancy_of_all, 1.0 - absorbed / static_cast<double>(repeated.size.size()));
}

/// What scatters within the poses, no more than all measurements do: one wrong row of few repeats tells nothing of the
/// others. And what all of a pose have in common.
void split_excess(const ResidualKind& kind, const RepeatedMeasurements& repeated, const Blocks& blocks,
                  double redundancy, ExcessNoise& excess) {
  const Blocks deviations = deviations_in_groups(repeated, blocks);
  double &own = excess.of[index(kind.kind)], &common = excess.of_pose[index(kind.kind)];
  own = std::min(own, excess_of(deviations.residuals, deviations.sd, kind.size, 1.0));
  const Blocks means = group_means(repeated, blocks, own);
  common = excess_of(means.residuals, means.sd, kind.size, redundancy_of_poses(redundancy, repeated));
}

/// The stated weights with `variance_of(k, i)` more of each measurement i of the kind k.
template <class VarianceOf>
Weights weights_with(const PoseSet& data, const std::optional<Instrument>& instrument, const VarianceOf& variance_of) {
  Weights weights = weights_of(data, instrument.value_or(Instrument{}));
  for (const ResidualKind& kind : residual_kinds()) {
    std::vector<Vec3>& sd = weights.of(kind.kind);
    for (std::size_t i = 0; i < sd.size(); ++i)
      sd[i] = (sd[i].cwiseAbs2().array() + variance_of(index(kind.kind), i)).sqrt();
  }
  weights.couplings = couplings_of(data, weights.of<PointMeasurement>(), weights.of<OrientationMeasurement>());
  return weights;
}

}  // namespace

RedundancyOfKinds equal_redundancy(const PoseSet& data, double parameters) {
  double residuals = 0.0;
  for (const ResidualKind& kind : residual_kinds()) residuals += kind.size * static_cast<double>(kind.count(data));
  RedundancyOfKinds redundancy;
  redundancy.fill(std::max(least_redundancy_of_all, 1.0 - parameters / std::max(1.0, residuals)));
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
  const std::array<RepeatedMeasurements, measurement_kinds> repeated = repeated_measurements(data);
  const std::array<Blocks, measurement_kinds> independent = blocks;
  const auto points = index(kind_of<PointMeasurement>), turns = index(kind_of<OrientationMeasurement>);
  if (!specified.couplings.empty())
    estimate_pose_noise(specified, data, redundancy, blocks[points], blocks[turns], excess);
  for (const ResidualKind& kind : residual_kinds())
    if (const auto k = index(kind.kind); !repeated[k].empty())
      split_excess(kind, repeated[k], in_common_axes(kind.kind, independent[k], data), redundancy[k], excess);
  return excess;
}

Weights weights_of(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  const std::array<RepeatedMeasurements, measurement_kinds> repeated = repeated_measurements(data);
  return weights_with(data, instrument, [&](std::size_t kind, std::size_t i) {
    const double m = repeated[kind].empty() ? 1.0 : repeated[kind].size_of(i);
    return excess.of[kind] * excess.of[kind] + m * excess.of_pose[kind] * excess.of_pose[kind];
  });
}

Weights weights_of_single(const PoseSet& data, const std::optional<Instrument>& instrument, const ExcessNoise& excess) {
  return weights_with(data, instrument, [&](std::size_t kind, std::size_t) {
    return excess.of[kind] * excess.of[kind] + excess.of_pose[kind] * excess.of_pose[kind];
  });
}

double evidence_of_repeats(const ResidualContext& scene, const std::optional<Instrument>& instrument,
                           const ExcessNoise& excess) {
  const std::array<RepeatedMeasurements, measurement_kinds> repeated = repeated_measurements(scene.data);
  const Weights together = weights_of(scene.data, instrument, excess);
  ExcessNoise own_excess = excess;
  own_excess.of_pose.fill(0.0);
  const Weights own = weights_of(scene.data, instrument, own_excess);
  double sum = 0.0;
  for (const ResidualKind& kind : residual_kinds()) {
    const RepeatedMeasurements& groups = repeated[index(kind.kind)];
    if (groups.empty() || !(excess.of_pose[index(kind.kind)] > 0.0)) continue;
    const std::vector<Vec3> residuals =
        in_common_axes(kind.kind, {residuals_of(kind, scene), own.of(kind.kind)}, scene.data).residuals;
    const std::vector<Vec3> means = means_of_groups(groups, residuals);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double m = groups.size_of(i), within = own.of(kind.kind)[i].head(kind.size).squaredNorm() / kind.size,
                   all = together.of(kind.kind)[i].head(kind.size).squaredNorm() / kind.size;
      const Vec3 deviation = residuals[i] - means[static_cast<std::size_t>(groups.group[i])];
      sum += deviation.squaredNorm() * (1.0 / within - 1.0 / all) - kind.size * (m - 1.0) / m * std::log(all / within);
    }
  }
  return sum;
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
