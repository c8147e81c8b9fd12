// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/displacement_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "kinfer/calibrate/functions/field_problem.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"
#include "kinfer/calibrate/functions/pose_means.hpp"
#include "kinfer/calibrate/functions/thresholds.hpp"
#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/measurement/commanded_poses.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Without measurements, with inducing points among the rows.
DisplacementField empty_field(const PoseSet& rows, const VectorXd& length, double size, double noise) {
  const MatrixXd points =
      rows.joints(Eigen::all, spread_indices(static_cast<int>(rows.rows()), thresholds::field_points));
  return {points, length, Eigen::Matrix3Xd::Zero(3, points.cols()), size, noise};
}

VectorXd field_length(const PoseSet& rows, double relative_length) {
  const MatrixXd centred = rows.joints.colwise() - rows.joints.rowwise().mean();
  const VectorXd spread = (centred.rowwise().squaredNorm() / static_cast<double>(rows.rows())).cwiseSqrt();
  // A joint that did not move has no say; its own scale would be that of its noise.
  const double largest = std::max(spread.maxCoeff(), 1e-9);
  return relative_length * spread.cwiseMax(1e-3 * largest);
}

/// [m] or [rad] of the first kind of measurements that shows the tool's position.
double position_sd(const Weights& weights) {
  return typical_sd(weights, [](const MeasurementTraits& traits) { return traits.observes.tool_position; });
}

/// Variance in units of the weights: theirs, but no less than a part of that of the field's own measurements. Residuals
/// beside a field that can follow nearly all of them say little of the noise, and a level found from these goes to zero
/// together with them.
double relative_noise(const DisplacementField& field, const Weights& weights) {
  const double least =
      thresholds::least_noise_beside_field * field.noise / std::max(position_sd(weights), noise_free_sd);
  return std::max(1.0, least * least);
}

/// Mean of the squared weighted residuals of each kind of measurements, 0 where there are none.
std::array<double, measurement_kinds> mean_squares(const Chain& fitted, const PoseSet& rows, const Weights& weights) {
  const EvaluatedPoses at = evaluate_poses(fitted, {}, rows, Derivative::no);
  const FixtureColumns no_columns = fixture_columns(fitted, {});
  const VectorXd r = weighted_residuals({fitted, rows, at, no_columns}, weights);
  std::array<double, measurement_kinds> squares{}, count{};
  Index row = 0;
  for (const Block& block : blocks_of(rows)) {
    squares[index(block.kind)] += r.segment(row, block.size).squaredNorm(), count[index(block.kind)] += block.size;
    row += block.size;
  }
  for (std::size_t k = 0; k < squares.size(); ++k) squares[k] /= std::max(1.0, count[k]);
  return squares;
}

/// Without outliers, and without kinds that do not show the tool's position and are better than stated: the evidence
/// has one noise level, and beside exact orientations a field takes all that is left for the small common one.
PoseSet weighing_measurements(const Estimate& fitted, const PoseSet& rows,
                              const std::optional<Instrument>& instrument) {
  const PoseSet inliers = keep_measurements(rows, inliers_of(fitted, rows));
  const Weights weights = weights_of(inliers, instrument, excess_noise(fitted.chain, inliers, instrument, 0.0));
  const auto squares = mean_squares(fitted.chain, inliers, weights);
  // A noise that was found from these residuals is not too large, unless they are exact.
  const double least = instrument ? thresholds::least_shown_noise : thresholds::least_estimated_noise;
  std::vector<bool> kept;
  for (const Block& block : blocks_of(inliers))
    kept.push_back(residual_kind(block.kind).traits.observes.tool_position || squares[index(block.kind)] >= least);
  return keep_measurements(inliers, kept);
}

}  // namespace

bool allows_field(const PoseSet& rows) {
  std::set<int> shown;
  for (const Block& block : blocks_of(rows))
    if (residual_kind(block.kind).traits.observes.tool_position) shown.insert(pose_of_row(rows, block.row));
  return rows.pairs.empty() && rows.tips.empty() && std::ssize(shown) >= thresholds::min_field_rows;
}

FoundField find_field(const Estimate& fitted, const PoseSet& rows, const std::optional<Instrument>& instrument,
                      int threads) {
  const PoseSet weighing = weighing_measurements(fitted, rows, instrument);
  const PoseMeans means = pose_means(fitted.chain, weighing, instrument,
                                     excess_noise(fitted.chain, weighing, instrument, 0.0, threads), threads);
  const PoseSet kept = select(means.rows, spread_indices(static_cast<int>(means.rows.rows()), thresholds::field_rows));
  const Weights weights = weights_of(kept, instrument, means.excess);
  FoundField best{fitted.chain};
  double highest = 0.0;
  for (const double length : thresholds::field_lengths) {
    Chain chain = fitted.chain;
    chain.field = empty_field(kept, field_length(kept, length), 0.0, 0.0);
    const FieldProblem problem(chain, fitted.parameters, {kept, weights, threads});
    const FieldProblem::Evidence evidence = problem.evidence(fitted.sigma);
    if (!best.chain.field.empty() && evidence.log_bayes_factor <= highest) continue;
    highest = evidence.log_bayes_factor;
    const FieldProblem::Solution solution = problem.solve(evidence.size, evidence.noise);
    best.chain = problem.moved_by(solution);
    best.chain.field.noise = std::sqrt(evidence.noise) * position_sd(weights);
    best.values = static_cast<int>(solution.values.size());
    best.determined = static_cast<int>(std::lround(solution.effective_number));
  }
  best.log_evidence_gain = highest - std::log(1.0 + static_cast<double>(thresholds::field_lengths.size()));
  return best;
}

Estimate fit_with_field(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                        const std::optional<Instrument>& instrument, const BundleOptions& options,
                        const Observer& observer) {
  double absorbed = 0.0;
  const auto fit_others = [&](const Chain& chain, Detail detail, InitialGuess guess, int iterations) {
    BundleOptions others = options;
    others.detail = detail, others.initial_guess = guess, others.max_iterations = iterations;
    others.absorbed = absorbed;
    return fit_with_series(chain, set, rows, instrument, others, observer);
  };
  const bool is_near = options.initial_guess == InitialGuess::near_optimum;  // only noise level and inliers are needed
  Estimate fit = fit_others(start, Detail::numbers_only, options.initial_guess, is_near ? 1 : options.max_iterations);
  MatrixXd covariance = fit.covariance;
  VectorXd variances = covariance.diagonal();
  for (int round = 0; round < thresholds::field_rounds; ++round) {
    const PoseSet inliers = keep_measurements(rows, inliers_of(fit, rows));
    const PoseMeans means =
        pose_means(fit.chain, inliers, instrument,
                   excess_noise(fit.chain, inliers, instrument, absorbed, options.threads), options.threads);
    const PoseSet& kept = means.rows;
    const Weights weights = weights_of(kept, instrument, means.excess);
    Chain present = fit.chain;
    if (round == 0) present.field = empty_field(kept, start.field.length, start.field.size, start.field.noise);
    const FieldProblem problem(present, set, {kept, weights, options.threads});
    const FieldProblem::Solution solution = problem.solve(start.field.size, relative_noise(start.field, weights));
    covariance = solution.covariance, variances = solution.marginal_variances, absorbed = solution.effective_number;
    fit.chain = problem.moved_by(solution);
    // One linear step from the optimum of nearly the same rows.
    if (is_near && round > 0 && problem.relative_gain(solution) <= thresholds::settled_noise) break;
    const double before = fit.sigma;
    fit = fit_others(fit.chain, Detail::numbers_only, InitialGuess::near_optimum, options.max_iterations);
    if (round > 0 && std::abs(fit.sigma - before) <= thresholds::settled_noise * before) break;
  }
  if (options.detail == Detail::all)
    fit = fit_others(fit.chain, Detail::all, InitialGuess::near_optimum, options.max_iterations);
  return with_covariance(std::move(fit), set, covariance, variances);
}

}  // namespace kinfer::calibrate
