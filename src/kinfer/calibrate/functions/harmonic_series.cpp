// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/harmonic_series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/calibrate/functions/pose_means.hpp"
#include "kinfer/calibrate/functions/series_problem.hpp"
#include "kinfer/calibrate/functions/thresholds.hpp"
#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Whether another joint follows this one: then it has no series, which would move that one too.
bool is_followed(const Chain& chain, std::size_t joint) {
  return std::ranges::any_of(chain.joints, [&](const Joint& other) {
    return std::ranges::any_of(other.couplings, [&](const Coupling& c) {
      return c.joint == static_cast<int>(joint) && std::abs(c.factor) > thresholds::followed;
    });
  });
}

/// Series of zeros for joints that turn far enough.
std::vector<JointSeries> zero_series(const Chain& chain, const PoseSet& rows, const Resolution& resolution) {
  const std::vector<int> q_index = active_joint_indices(chain);
  std::vector<JointSeries> series;
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    if (q_index[j] < 0 || !rotates(chain.joints[j].type) || is_followed(chain, j)) continue;
    const auto q = rows.joints.row(q_index[j]);
    if (q.maxCoeff() - q.minCoeff() >= thresholds::min_series_range)
      series.push_back({static_cast<int>(j), resolution, VectorXd::Zero(resolution.knots)});
  }
  return series;
}

struct Candidate {
  DetachedSeries model;
  double log_evidence = 0.0;
  std::vector<double> bayes_factors;  // log, of each series
};

/// With the sizes and the noise level that maximise the marginal likelihood.
Candidate evaluate(const DetachedSeries& start, const WeightedRows& data) {
  SeriesProblem problem(start, data);
  const SeriesProblem::Solution solution = problem.maximise(thresholds::series_rounds);
  Candidate candidate{problem.moved_by(solution.step), problem.log_evidence(solution), {}};
  for (std::size_t k = 0; k < start.series.size(); ++k)
    candidate.bayes_factors.push_back(problem.log_bayes_factor(solution, k));
  return candidate;
}

/// Drops series one by one, the one with the least odds first, until each has more than the prior odds of one among
/// all. None where none is left.
std::optional<Candidate> keep_supported(Candidate candidate, DetachedSeries plain, const WeightedRows& data,
                                        double log_odds) {
  while (!candidate.bayes_factors.empty()) {
    const auto worst = std::ranges::min_element(candidate.bayes_factors);
    if (*worst > log_odds) return candidate;
    plain.series = candidate.model.series;
    plain.series.erase(plain.series.begin() + (worst - candidate.bayes_factors.begin()));
    candidate = evaluate(plain, data);
  }
  return std::nullopt;
}

ParameterSet without_harmonics(const ParameterSet& set) {
  ParameterSet kept;
  std::vector<Index> free;
  Index k = 0;
  for (const Parameter& p : set.parameters) {
    const JointNumber* at = joint_number(p.at);
    const bool is_harmonic = at && is_harmonic_field(at->field);
    if (!is_harmonic) kept.parameters.push_back(p);
    if (p.free && !is_harmonic) free.push_back(k);
    k += p.free;
  }
  // Harmonics are independent of all other parameters a priori.
  if (set.prior_sqrt_information.size() > 0) kept.prior_sqrt_information = set.prior_sqrt_information(free, free);
  return kept;
}

}  // namespace

std::optional<FoundSeries> find_series(const Estimate& fitted, const PoseSet& rows,
                                       const std::optional<Instrument>& instrument, int threads) {
  if (!rows.pairs.empty() || distinct_poses(rows) < thresholds::min_series_points) return std::nullopt;
  const PoseSet inliers = keep_measurements(rows, inliers_of(fitted, rows));
  const PoseMeans means = pose_means(fitted.chain, inliers, instrument,
                                     excess_noise(fitted.chain, inliers, instrument, 0.0, threads), threads);
  const PoseSet& kept = means.rows;
  const Weights weights = weights_of(kept, instrument, means.excess);
  const WeightedRows data{kept, weights, threads};
  const double without = evaluate({fitted.chain, fitted.parameters, {}}, data).log_evidence;
  DetachedSeries start{fitted.chain, without_harmonics(fitted.parameters), {}};
  for (Joint& joint : start.plain.joints) joint.harmonics.clear();  // those of gears are orders of the series
  std::optional<Candidate> best;
  for (const Resolution& resolution : resolutions) {
    start.series = zero_series(start.plain, kept, resolution);
    if (start.series.empty()) return std::nullopt;
    Candidate candidate = evaluate(start, data);
    if (best && candidate.log_evidence <= best->log_evidence) break;
    best = std::move(candidate);
  }
  const double log_odds = std::log(static_cast<double>(start.series.size() * resolutions.size()) + 1.0);
  best = keep_supported(*std::move(best), start, data, log_odds);
  if (!best) return std::nullopt;
  const double gain = best->log_evidence - without - log_odds;
  if (!(gain > 0.0)) return std::nullopt;
  return FoundSeries{attach(best->model.plain, best->model.series), start.set, gain};
}

Estimate fit_with_series(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                         const std::optional<Instrument>& instrument, const BundleOptions& options,
                         const Observer& observer) {
  if (!has_series(start)) return fit_bundle(start, set, rows, instrument, options, observer);
  DetachedSeries model = detach(start, set);
  PoseSet moved = with_moved_joints(rows, model.plain, model.series);
  const auto fit_others = [&](Detail detail, InitialGuess guess, int iterations) {
    BundleOptions others = options;
    others.detail = detail, others.initial_guess = guess, others.max_iterations = iterations;
    return fit_bundle(model.plain, model.set, moved, instrument, others, observer);
  };
  const bool is_near = options.initial_guess == InitialGuess::near_optimum;  // only noise level and inliers are needed
  Estimate fit = fit_others(Detail::numbers_only, options.initial_guess, is_near ? 1 : options.max_iterations);
  model.plain = fit.chain;
  MatrixXd covariance = fit.covariance, beside_series = covariance, response;
  for (int round = 0; round < thresholds::series_rounds; ++round) {
    const std::vector<bool> inliers = inliers_of(fit, rows);
    const PoseSet kept_moved = keep_measurements(moved, inliers);
    PoseMeans means =
        pose_means(model.plain, kept_moved, instrument,
                   excess_noise(model.plain, kept_moved, instrument, 0.0, options.threads), options.threads);
    const Weights weights = weights_of(means.rows, instrument, means.excess);
    PoseSet& kept = means.rows;
    kept.joints = rows.joints(Eigen::all, means.of_row);
    const SeriesProblem problem(model, {kept, weights, options.threads});
    SeriesProblem::Step step = problem.step();
    const double gain = problem.relative_gain(step.step);
    covariance = std::move(step.covariance), beside_series = std::move(step.covariance_beside_series);
    response = std::move(step.response);
    model = problem.moved_by(step.step);
    if (is_near && gain <= thresholds::settled_noise)
      break;  // one linear step from the optimum of nearly the same rows
    moved = with_moved_joints(rows, model.plain, model.series);
    const double before = fit.sigma;
    fit = fit_others(Detail::numbers_only, InitialGuess::near_optimum, options.max_iterations);
    model.plain = fit.chain;
    if (std::abs(fit.sigma - before) <= thresholds::settled_noise * before) break;
  }
  if (options.detail == Detail::all) {
    moved = with_moved_joints(rows, model.plain, model.series);
    fit = fit_others(Detail::all, InitialGuess::near_optimum, options.max_iterations);
    model.plain = fit.chain;
  }
  fit.chain = attach(model.plain, model.series);
  fit.series_response = response;
  Estimate found = with_covariance(std::move(fit), set, covariance, covariance.diagonal());
  found.covariance_beside_series = std::move(beside_series);
  return found;
}

}  // namespace kinfer::calibrate
