// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/functions/fit_with_functions.hpp"
#include "kinfer/calibrate/prediction/measured_region.hpp"
#include "kinfer/calibrate/prediction/thresholds.hpp"
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// A residual of three components that its fit did not see, along the axes of the base.
struct HeldOutResidual {
  Vec3 residual = Vec3::Zero();    ///< [m] or [rad]
  Mat3 parameters = Mat3::Zero();  ///< covariance by the fit's parameters
  Mat3 noise = Mat3::Zero();       ///< covariance of the instrument
  double outside = 0.0;            ///< share of the outside error at its joint positions
  Mat3 open = Mat3::Zero();        ///< covariance that a displacement field and fading corrections leave open
  bool is_tool_point = false;      ///< not another target, whose own uncertainty `parameters` lacks

  /// `noise_part`: of what follows from the noise; what a field leaves open does not.
  Mat3 explained(double noise_part = 1.0) const { return noise_part * (parameters + noise) + open; }
};

struct HeldOutResiduals {
  std::vector<HeldOutResidual> points, rotations;
};

HeldOutResidual in_base(const Mat3& world_R_base, const Vec3& residual, const MatrixXd& jacobian,
                        const MatrixXd& covariance, const Mat3& noise) {
  return {world_R_base.transpose() * residual,
          world_R_base.transpose() * propagated_covariance(jacobian, covariance) * world_R_base,
          world_R_base.transpose() * noise * world_R_base};
}

/// Measurements of one pose are one residual, their mean: the errors of the model and of its parameters are common to
/// all. `common`: variance of the noise that is, too.
std::vector<HeldOutResidual> means_of_poses(const std::vector<HeldOutResidual>& all, const RepeatedMeasurements& groups,
                                            double common) {
  if (groups.empty()) return all;
  const Mat3 shared = common * Mat3::Identity();
  std::vector<HeldOutResidual> means(groups.size.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    HeldOutResidual& mean = means[static_cast<std::size_t>(groups.group[i])];
    const double part = 1.0 / groups.size_of(i);
    mean.residual += part * all[i].residual;
    mean.parameters += part * all[i].parameters;
    mean.noise += part * (part * (all[i].noise - shared) + shared);
    mean.outside += part * all[i].outside;
    mean.open += part * all[i].open;
    mean.is_tool_point = all[i].is_tool_point;
  }
  return means;
}

/// Residuals of `rows`, which `fit` did not see, by what `model` predicts from it.
HeldOutResiduals residuals_of(const Estimate& fit, const PredictionModel& model, const PoseSet& rows,
                              const std::optional<Instrument>& instrument) {
  HeldOutResiduals all;
  const std::vector<PredictedPose> predicted = predicted_with_spread(fit.chain, model, rows);
  const Instrument assumed = with_lengths(instrument.value_or(Instrument{.sigma_angle = fit.sigma_angle}), fit.sigma);
  const Weights weights = weights_of(rows, assumed);
  const EvaluatedPoses at = evaluate_poses(fit.chain, fit.parameters, rows, Derivative::yes);
  const FieldRoots roots = roots_of(fit.chain.field);
  const auto world_R_base = [&](int row) {
    return with_mounting(fit.chain, rows.mounting.empty() ? -1 : rows.mounting[static_cast<std::size_t>(row)])
        .base.pose()
        .rotation;
  };
  for (std::size_t k = 0; k < rows.points.size(); ++k) {
    const PointMeasurement& point = rows.points[k];
    const auto& [tool, weight, shift, turn] = predicted[static_cast<std::size_t>(point.row)];
    const Vec3 arm = point.target < 0 ? Vec3::Zero().eval() : Vec3(tool.rotation * fit.chain.targets[point.target].xyz);
    all.points.push_back(in_base(world_R_base(point.row), point.position - tool.position - arm,
                                 point_columns(at.twists[point.row], arm), covariance_of_predictions(fit),
                                 covariance_of(weights.of<PointMeasurement>()[k], point.axes)));
    const Vec3 apart = world_R_base(point.row).transpose() * shift;
    all.points.back().open =
        displacement_variance(fit.chain.field, roots, rows.joints.col(point.row)) * Mat3::Identity() +
        weight * (1.0 - weight) * apart * apart.transpose();
    all.points.back().is_tool_point = point.target < 0;
  }
  for (std::size_t k = 0; k < rows.orientations.size(); ++k) {
    const OrientationMeasurement& measured = rows.orientations[k];
    const auto& [tool, weight, shift, faded] = predicted[static_cast<std::size_t>(measured.row)];
    const Vec3 turn = log_so3(measured.orientation.toRotationMatrix() * tool.rotation.transpose());
    const MatrixXd jacobian = at.twists[measured.row].bottomRows<3>();
    all.rotations.push_back(in_base(world_R_base(measured.row), turn, jacobian, covariance_of_predictions(fit),
                                    covariance_of(weights.of<OrientationMeasurement>()[k], measured.axes)));
    const Vec3 apart = world_R_base(measured.row).transpose() * faded;
    all.rotations.back().open = weight * (1.0 - weight) * apart * apart.transpose();
  }
  return all;
}

/// Residuals of `rows` by a fit to `train`, and how far outside of it they lie in the units of the final region.
HeldOutResiduals residuals_beside(const Estimate& fit, const PoseSet& train, const PoseSet& rows,
                                  const std::optional<Instrument>& instrument, PredictionModel region) {
  region.rows = representatives(train.joints);
  HeldOutResiduals all = residuals_of(fit, region, rows, instrument);
  VectorXd outside(rows.rows());
  for (Index row = 0; row < rows.rows(); ++row) outside[row] = outside_share(region, rows.joints.col(row));
  for (std::size_t k = 0; k < all.points.size(); ++k) all.points[k].outside = outside[rows.points[k].row];
  for (std::size_t k = 0; k < all.rotations.size(); ++k) all.rotations[k].outside = outside[rows.orientations[k].row];
  const auto repeated = repeated_measurements(rows);
  const bool is_stated = instrument && instrument->states_lengths();
  all.points = means_of_poses(all.points, repeated[index(kind_of<PointMeasurement>)],
                              is_stated ? 0.0 : fit.sigma_pose * fit.sigma_pose);
  all.rotations = means_of_poses(all.rotations, repeated[index(kind_of<OrientationMeasurement>)], 0.0);
  return all;
}

void append(HeldOutResiduals& to, const HeldOutResiduals& more) {
  to.points.insert(to.points.end(), more.points.begin(), more.points.end());
  to.rotations.insert(to.rotations.end(), more.rotations.begin(), more.rotations.end());
}

HeldOutResiduals held_out_residuals(const EvaluationInputs& evaluated, const PredictionModel& region) {
  HeldOutResiduals all;
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Split& split = evaluated.plan.validation_splits[i];
    append(all, residuals_beside(evaluated.fits[i].after, select(evaluated.data, split.train),
                                 select(evaluated.data, without(split.holdout, evaluated.gross_errors)),
                                 evaluated.instrument, region));
  }
  return all;
}

/// Squared Mahalanobis length. By Cramer's rule: called a hundred times for each of thousands of rows.
double squared_length(const HeldOutResidual& r, const Mat3& covariance) {
  const Vec3 a = covariance.col(0), b = covariance.col(1), c = covariance.col(2);
  const double volume = a.dot(b.cross(c));
  if (!(volume > 0.0)) return std::numeric_limits<double>::infinity();
  const Vec3& x = r.residual;
  return x.dot(Vec3(b.cross(c).dot(x), c.cross(a).dot(x), a.cross(b).dot(x))) / volume;
}

/// Whether the covariances that residuals are compared with were found from as many residuals themselves.
enum class NoiseKnowledge { stated, estimated };

/// How much larger the mean square of n Gaussian residuals is to be counted, so that an ellipsoid that is scaled by it
/// holds 95 % of further ones: Hotelling's T² over chi-squared.
double sampling_factor(double n) {
  const double t_squared =
      3.0 * (n - 1.0) * (n + 1.0) / (n * (n - 3.0)) * f_quantile(thresholds::ellipsoid_content, 3.0, n - 3.0);
  return t_squared / chi_squared_quantile(thresholds::ellipsoid_content, 3.0);
}

/// Below it lie 95 % of further values on the average, whatever their distribution: of n sorted values, the one of
/// rank 0.95 (n + 1); the largest where there is none.
double upper_limit(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double rank = thresholds::ellipsoid_content * (n + 1.0);
  return quantile(values, std::min(1.0, (rank - 1.0) / (n - 1.0)));
}

/// How large the residuals are for their covariances, 1 where 95 % of further ones lie within the 95 % ellipsoids. Few
/// residuals have no 95 % point of their own: their mean square counts as much more, the fewer they are.
double relative_size(std::vector<double> squares, NoiseKnowledge noise) {
  const auto count = static_cast<double>(squares.size());
  const bool is_stated = noise == NoiseKnowledge::stated;
  const double limit = is_stated ? quantile(squares, thresholds::ellipsoid_content) : upper_limit(squares);
  const double largest = thresholds::clipped_length * quantile(squares, 0.5);
  for (double& s : squares) s = std::min(s, largest);
  const double by_mean = (is_stated ? 1.0 : sampling_factor(count)) * mean(squares) / 3.0,
               by_limit = limit / chi_squared_quantile(thresholds::ellipsoid_content, 3.0);
  const double trust = count / (count + thresholds::trusted_quantile_rows);
  return std::exp(trust * std::log(std::max(by_limit, 1e-300)) + (1.0 - trust) * std::log(std::max(by_mean, 1e-300)));
}

/// The least factor in [0, largest_factor] with which `size(factor)`, which falls with it, is at most 1.
template <class Size>
double least_factor(Size size) {
  if (size(0.0) <= 1.0) return 0.0;
  double low = 0.0, high = 1e-6;
  while (high < thresholds::largest_model_error_factor && size(high) > 1.0) low = high, high *= 4.0;
  for (int i = 0; i < 25; ++i) {
    const double middle = 0.5 * (low + high);
    (size(middle) > 1.0 ? low : high) = middle;
  }
  return high;
}

/// Mean of r rᵀ − explained over the residuals, large ones shortened; negative directions count as a small part of the
/// rest.
Mat3 mean_excess(const std::vector<HeldOutResidual>& residuals) {
  std::vector<double> squares;
  for (const HeldOutResidual& r : residuals) squares.push_back(r.residual.squaredNorm());
  const double largest = thresholds::clipped_length * median(squares);
  Mat3 excess = Mat3::Zero(), total = Mat3::Zero();
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double shorten = squares[i] > largest ? largest / squares[i] : 1.0;
    const Mat3 square = shorten * residuals[i].residual * residuals[i].residual.transpose();
    total += square, excess += square - residuals[i].explained();
  }
  const auto n = static_cast<double>(residuals.size());
  const SymmetricEigen eigen = symmetric_eigen(MatrixXd(excess / n));
  const double least = thresholds::least_excess * total.trace() / n / 3.0;
  return eigen.vectors * eigen.values.cwiseMax(least).asDiagonal() * eigen.vectors.transpose();
}

/// The model error among the fitted rows, and what it gains outside of them.
struct ModelErrors {
  Mat3 inside = Mat3::Zero(), outside = Mat3::Zero();
  double noise_part = 1.0;  ///< of the variance that the residuals of the fits show, where the instrument is not stated

  Mat3 covariance_of(const HeldOutResidual& r) const { return r.explained(noise_part) + inside + r.outside * outside; }
};

double size_with(const std::vector<HeldOutResidual>& residuals, const ModelErrors& errors, NoiseKnowledge noise) {
  std::vector<double> squares;
  for (const HeldOutResidual& r : residuals) squares.push_back(squared_length(r, errors.covariance_of(r)));
  return relative_size(std::move(squares), noise);
}

Mat3 error_inside(const std::vector<HeldOutResidual>& residuals, const Mat3& outside, NoiseKnowledge noise) {
  if (residuals.size() < thresholds::min_model_error_rows) return Mat3::Zero();
  const Mat3 shape = mean_excess(residuals);
  return shape * least_factor([&](double factor) { return size_with(residuals, {factor * shape, outside}, noise); });
}

/// Residuals of halves of the joint space that their fits did not see.
std::vector<HeldOutResiduals> residuals_of_regions(const EvaluationInputs& evaluated, const Estimate& estimate,
                                                   const PredictionModel& region, int threads) {
  const std::vector<int> usable = without(evaluated.plan.fitted, evaluated.gross_errors);
  const PoseSet data = thin_pose_set(select(evaluated.data, usable), thresholds::region_fit_rows);
  const std::vector<Split> splits = extrapolation_splits(data);
  std::vector<HeldOutResiduals> of_split(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    const PoseSet train = select(data, splits[i].train), rest = select(data, splits[i].holdout);
    if (train.points.empty() || rest.points.empty()) return;
    const Estimate fit =
        fit_with_functions(estimate.chain, evaluated.nominal, estimate.parameters, train, evaluated.instrument,
                           {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only});
    of_split[i] = residuals_beside(fit, train, rest, evaluated.instrument, region);
  });
  return of_split;
}

/// What the errors gain outside: their mean excess over all regions, alike in all directions, and as much larger as the
/// hardest of these needs.
Mat3 error_outside(const std::vector<std::vector<HeldOutResidual>>& of_regions, const Mat3& inside) {
  std::vector<HeldOutResidual> all;
  double shares = 0.0;
  for (const std::vector<HeldOutResidual>& region : of_regions)
    for (const HeldOutResidual& r : region) all.push_back(r), shares += r.outside;
  if (all.size() < thresholds::min_model_error_rows || shares == 0.0) return thresholds::default_outside * inside;
  const double mean_variance = mean_excess(all).trace() / 3.0;
  const Mat3 mean_outside = mean_variance * static_cast<double>(all.size()) / shares * Mat3::Identity();
  double hardest = 0.0;
  for (const std::vector<HeldOutResidual>& region : of_regions)
    if (region.size() >= thresholds::min_model_error_rows)
      hardest = std::max(hardest, least_factor([&](double factor) {
                           return size_with(region, {inside, factor * mean_outside}, NoiseKnowledge::stated);
                         }));
  return std::min(thresholds::largest_outside_factor, hardest) * mean_outside;
}

/// No more than the held-out rows among the fitted ones bear, where their noise is stated: some lie at the edge too.
Mat3 bounded_outside(const Mat3& outside, const std::vector<HeldOutResidual>& held_out, NoiseKnowledge noise) {
  if (noise == NoiseKnowledge::estimated || held_out.size() < thresholds::min_model_error_rows) return outside;
  const auto size = [&](double factor) { return size_with(held_out, {Mat3::Zero(), factor * outside}, noise); };
  return size(1.0) >= 1.0 ? outside : Mat3(least_factor(size) * outside);
}

/// Residuals of fits tell the noise and the model error together, and wild rows widen both: what is left for the noise
/// so that 95 % of the held-out rows lie within their 95 % ellipsoids. Few rows say less of it.
double noise_part(const std::vector<HeldOutResidual>& held_out, ModelErrors errors) {
  if (held_out.size() < thresholds::min_model_error_rows) return 1.0;
  const double least = least_factor([&](double part) {
    errors.noise_part = part;
    return size_with(held_out, errors, NoiseKnowledge::estimated);
  });
  const auto count = static_cast<double>(held_out.size());
  return std::pow(std::clamp(least, thresholds::least_noise, 1.0), count / (count + thresholds::trusted_quantile_rows));
}

/// With the parameters' covariance as it is kept.
void scale_parameters(std::vector<HeldOutResidual>& residuals, double factor) {
  for (HeldOutResidual& r : residuals) r.parameters *= factor;
}

/// They depend on each other: held-out rows among the fitted ones lie at the edge too.
ModelErrors model_errors(const std::vector<HeldOutResidual>& held_out,
                         const std::vector<std::vector<HeldOutResidual>>& of_regions, NoiseKnowledge noise) {
  ModelErrors errors{error_inside(held_out, Mat3::Zero(), noise)};
  for (int round = 0; round < thresholds::outside_rounds; ++round) {
    errors.outside = bounded_outside(error_outside(of_regions, errors.inside), held_out, noise);
    errors.inside = error_inside(held_out, errors.outside, noise);
  }
  return errors;
}

std::optional<double> predicted_rms(const std::vector<HeldOutResidual>& residuals, const ModelErrors& errors) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const HeldOutResidual& r : residuals) {
    if (!r.is_tool_point) continue;
    squares += errors.covariance_of(r).trace();
    ++count;
  }
  if (count < thresholds::min_model_error_rows) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}

/// What the free parameters of the estimate change by far from the fitted rows: those that `beyond` lacks return to
/// their prior means.
VectorXd change_beyond(const Estimate& estimate, const Estimate& beyond) {
  const std::vector<const Parameter*> free = estimate.parameters.free(), kept = beyond.parameters.free();
  VectorXd change(static_cast<Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const bool has = std::ranges::any_of(kept, [&](const Parameter* p) { return p->at == free[k]->at; });
    const double far = has ? value_at(beyond.chain, free[k]->at) : free[k]->nominal;
    change[static_cast<Index>(k)] = far - value_at(estimate.chain, free[k]->at);
  }
  return change;
}

}  // namespace

std::optional<HeldOutPrediction> make_prediction_model(const EvaluationInputs& evaluated, const Estimate& estimate,
                                                       const std::optional<Estimate>& beyond, int threads) {
  if (evaluated.data.points.empty()) return std::nullopt;
  PredictionModel model;
  for (const Parameter* parameter : estimate.parameters.free()) model.parameters.push_back(parameter->name);
  model.root = covariance_root(covariance_of_predictions(estimate));
  if (beyond) model.beyond = change_beyond(estimate, *beyond);
  describe_region(model, evaluated.data.joints(Eigen::all, evaluated.plan.fitted));
  HeldOutResiduals held_out = held_out_residuals(evaluated, model);
  std::vector<std::vector<HeldOutResidual>> points_of_regions, rotations_of_regions;
  for (HeldOutResiduals& region : residuals_of_regions(evaluated, estimate, model, threads)) {
    points_of_regions.push_back(std::move(region.points));
    rotations_of_regions.push_back(std::move(region.rotations));
  }
  const NoiseKnowledge noise = evaluated.instrument && evaluated.instrument->states_lengths()
                                   ? NoiseKnowledge::stated
                                   : NoiseKnowledge::estimated;
  ModelErrors points = model_errors(held_out.points, points_of_regions, noise);
  if (noise == NoiseKnowledge::estimated) {
    points.noise_part = noise_part(held_out.points, points);
    model.noise = std::sqrt(points.noise_part) * estimate.sigma;
    model.root *= std::sqrt(points.noise_part);
    scale_parameters(held_out.rotations, points.noise_part);
    for (std::vector<HeldOutResidual>& region : rotations_of_regions) scale_parameters(region, points.noise_part);
  }
  const ModelErrors rotations = model_errors(held_out.rotations, rotations_of_regions, noise);
  model.model_error.topLeftCorner<3, 3>() = points.inside;
  model.outside_error.topLeftCorner<3, 3>() = points.outside;
  model.model_error.bottomRightCorner<3, 3>() = rotations.inside;
  model.outside_error.bottomRightCorner<3, 3>() = rotations.outside;
  return HeldOutPrediction{model, predicted_rms(held_out.points, points)};
}

}  // namespace kinfer::calibrate
