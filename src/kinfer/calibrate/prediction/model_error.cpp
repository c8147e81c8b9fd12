// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/prediction/measured_region.hpp"
#include "kinfer/calibrate/prediction/thresholds.hpp"
#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// A residual of three components that its fit did not see, along the axes of the base.
struct HeldOutResidual {
  Vec3 residual = Vec3::Zero();   ///< [m] or [rad]
  Mat3 explained = Mat3::Zero();  ///< covariance by the fit's parameters and the instrument
  double region_distance = 0.0;   ///< of its joint positions from the fitted rows
  bool is_tool_point = false;     ///< not another target, whose own uncertainty `explained` lacks
};

struct HeldOutResiduals {
  std::vector<HeldOutResidual> points, rotations;
};

HeldOutResidual in_base(const Mat3& world_R_base, const Vec3& residual, const MatrixXd& jacobian,
                        const MatrixXd& covariance, const Mat3& noise) {
  return {world_R_base.transpose() * residual,
          world_R_base.transpose() * (propagated_covariance(jacobian, covariance) + noise) * world_R_base};
}

/// Residuals of `rows`, which `fit` did not see.
void collect(HeldOutResiduals& all, const Estimate& fit, const PoseSet& rows,
             const std::optional<Instrument>& instrument) {
  const Instrument assumed = instrument.value_or(Instrument{.sigma = fit.sigma, .sigma_angle = fit.sigma_angle});
  const Weights weights = weights_of(rows, assumed);
  const EvaluatedPoses at = evaluate_poses(fit.chain, fit.parameters, rows, Derivative::yes);
  const auto world_R_base = [&](int row) {
    return with_mounting(fit.chain, rows.mounting.empty() ? -1 : rows.mounting[static_cast<std::size_t>(row)])
        .base.pose()
        .rotation;
  };
  for (std::size_t k = 0; k < rows.points.size(); ++k) {
    const PointMeasurement& point = rows.points[k];
    const Pose& tool = at.pose[point.row];
    const Vec3 arm = point.target < 0 ? Vec3::Zero().eval() : Vec3(tool.rotation * fit.chain.targets[point.target].xyz);
    all.points.push_back(in_base(world_R_base(point.row), point.position - tool.position - arm,
                                 point_columns(at.twists[point.row], arm), fit.covariance,
                                 covariance_of(weights.of<PointMeasurement>()[k], point.axes)));
    all.points.back().is_tool_point = point.target < 0;
  }
  for (std::size_t k = 0; k < rows.orientations.size(); ++k) {
    const OrientationMeasurement& measured = rows.orientations[k];
    const Vec3 turn = log_so3(measured.orientation.toRotationMatrix() * at.pose[measured.row].rotation.transpose());
    const MatrixXd jacobian = at.twists[measured.row].bottomRows<3>();
    all.rotations.push_back(in_base(world_R_base(measured.row), turn, jacobian, fit.covariance,
                                    covariance_of(weights.of<OrientationMeasurement>()[k], measured.axes)));
  }
}

/// Residuals of `rows` by a fit to `train`, with their distances from it in the units of the final region.
HeldOutResiduals residuals_beside(const Estimate& fit, const PoseSet& train, const PoseSet& rows,
                                  const std::optional<Instrument>& instrument, PredictionModel region) {
  HeldOutResiduals all;
  collect(all, fit, rows, instrument);
  region.rows = representatives(train.joints);
  VectorXd distance(rows.rows());
  for (Index row = 0; row < rows.rows(); ++row) distance[row] = region_distance(region, rows.joints.col(row));
  for (std::size_t k = 0; k < all.points.size(); ++k) all.points[k].region_distance = distance[rows.points[k].row];
  for (std::size_t k = 0; k < all.rotations.size(); ++k)
    all.rotations[k].region_distance = distance[rows.orientations[k].row];
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

/// Squared Mahalanobis length, with a model error. By Cramer's rule: called a hundred times for each of thousands of
/// rows.
double squared_length(const HeldOutResidual& r, const Mat3& model_error) {
  const Mat3 covariance = r.explained + model_error;
  const Vec3 a = covariance.col(0), b = covariance.col(1), c = covariance.col(2);
  const double volume = a.dot(b.cross(c));
  if (!(volume > 0.0)) return std::numeric_limits<double>::infinity();
  const Vec3& x = r.residual;
  return x.dot(Vec3(b.cross(c).dot(x), c.cross(a).dot(x), a.cross(b).dot(x))) / volume;
}

/// How large the residuals are for their covariances, 1 where 95 % of them lie within the 95 % ellipsoids. Few
/// residuals have no 95 % point of their own: their mean square counts as much more, the fewer they are.
double relative_size(std::vector<double> squares) {
  const double limit = chi_squared_quantile(thresholds::ellipsoid_content, 3.0);
  const double at_limit = quantile(squares, thresholds::ellipsoid_content) / limit;
  const double largest = thresholds::clipped_length * quantile(squares, 0.5);
  for (double& s : squares) s = std::min(s, largest);
  const double by_mean = mean(squares) / 3.0, count = static_cast<double>(squares.size());
  const double trust = count / (count + thresholds::trusted_quantile_rows);
  return std::exp(trust * std::log(std::max(at_limit, 1e-300)) + (1.0 - trust) * std::log(std::max(by_mean, 1e-300)));
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
    total += square, excess += square - residuals[i].explained;
  }
  const auto n = static_cast<double>(residuals.size());
  const SymmetricEigen eigen = symmetric_eigen(MatrixXd(excess / n));
  const double least = thresholds::least_excess * total.trace() / n / 3.0;
  return eigen.vectors * eigen.values.cwiseMax(least).asDiagonal() * eigen.vectors.transpose();
}

double size_with(const std::vector<HeldOutResidual>& residuals, const Mat3& model_error, double rate) {
  std::vector<double> squares;
  for (const HeldOutResidual& r : residuals)
    squares.push_back(squared_length(r, (1.0 + rate * r.region_distance * r.region_distance) * model_error));
  return relative_size(std::move(squares));
}

Mat3 model_error(const std::vector<HeldOutResidual>& residuals, double rate) {
  if (residuals.size() < thresholds::min_model_error_rows) return Mat3::Zero();
  const Mat3 shape = mean_excess(residuals);
  return shape * least_factor([&](double factor) { return size_with(residuals, factor * shape, rate); });
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
    const Estimate fit = fit_bundle(estimate.chain, estimate.parameters, train, evaluated.instrument,
                                    {.initial_guess = InitialGuess::near_optimum, .detail = Detail::numbers_only});
    of_split[i] = residuals_beside(fit, train, rest, evaluated.instrument, region);
  });
  return of_split;
}

/// The largest that one of the regions needs: which of them is the hardest, is not known in advance of others.
double growth_rate(const std::vector<HeldOutResiduals>& of_regions, const Mat3& model_error) {
  double largest = of_regions.empty() ? thresholds::default_growth_rate : 0.0;
  for (const auto& [points, rotations] : of_regions) {
    if (points.size() < thresholds::min_model_error_rows) continue;
    const auto& list = points;  // clang 14 captures no structured binding
    largest = std::max(largest, least_factor([&](double rate) { return size_with(list, model_error, rate); }));
  }
  return std::min(thresholds::largest_growth_rate, largest);
}

std::optional<double> predicted_rms(const std::vector<HeldOutResidual>& residuals, const Mat3& model_error,
                                    double rate) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const HeldOutResidual& r : residuals) {
    if (!r.is_tool_point) continue;
    squares += r.explained.trace() + (1.0 + rate * r.region_distance * r.region_distance) * model_error.trace();
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
  model.root = covariance_root(estimate.covariance);
  if (!evaluated.instrument) model.noise = estimate.sigma;
  if (beyond) model.beyond = change_beyond(estimate, *beyond);
  describe_region(model, evaluated.data.joints(Eigen::all, evaluated.plan.fitted));
  const HeldOutResiduals held_out = held_out_residuals(evaluated, model);
  const std::vector<HeldOutResiduals> of_regions = residuals_of_regions(evaluated, estimate, model, threads);
  // Size and growth depend on each other: the held-out rows have distances too.
  Mat3 of_points = model_error(held_out.points, 0.0);
  for (int round = 0; round < thresholds::growth_rounds && of_points.trace() > 0.0; ++round) {
    model.rate = growth_rate(of_regions, of_points);
    of_points = model_error(held_out.points, model.rate);
  }
  model.model_error.topLeftCorner<3, 3>() = of_points;
  model.model_error.bottomRightCorner<3, 3>() = model_error(held_out.rotations, model.rate);
  return HeldOutPrediction{model, predicted_rms(held_out.points, of_points, model.rate)};
}

}  // namespace kinfer::calibrate
