// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/instrument_scales.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/solver/model_error.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/identify/refinement/scales/scale_evidence.hpp"
#include "kinfer/identify/refinement/scales/scale_parameters.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using namespace scale_parameters;
using Index = Eigen::Index;

constexpr int most_rounds = 3;

/// Of one instrument's matrix, column by column: of what the model does not explain, each part may look like a scale
/// error, and so may the noise of what the instrument hardly measures.
VectorXd unexplained_scales(const std::vector<InsBlock>& blocks, double noise, double considered) {
  const Vec3 dilution = regression_dilution(blocks, noise);
  VectorXd sd(elements);
  for (Index axis = 0; axis < 3; ++axis) sd.segment<3>(3 * axis).setConstant(std::hypot(considered, dilution[axis]));
  return sd;
}

VectorXd unexplained_scales(const InsProblem& problem, const InsCost& cost) {
  VectorXd sd(each * static_cast<Index>(problem.sensors.size()));
  const std::vector<ConsideredScale> considered = considered_scales(problem, cost);
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const InsMeasurements& r = problem.sensors[s];
    const Index at = each * static_cast<Index>(s);
    sd.segment<elements>(at) =
        unexplained_scales(r.angular_velocity, r.noise.angular_velocity, considered[s].gyroscope);
    sd.segment<elements>(at + elements) = unexplained_scales(r.force, r.noise.force, considered[s].accelerometer);
  }
  return sd;
}

/// What the recording tells of the scales, under the priors without factors, model errors among the scales.
std::optional<ScaleEstimate> scale_estimate(const RefinementTask& task, RefinementFit& fitted) {
  const InsFit& fit = fitted.fit;
  InsProblem& problem = fitted.setup.problem;
  const auto global = long_run_estimate(problem, fit.layout, fit.unknowns, fit.cost, task.options.threads);
  if (!global) return std::nullopt;
  const std::vector<Index> at = indices_of_scales(fit.layout);
  const auto fitted_information = invert_spd(global->covariance(at, at));
  if (!fitted_information) return std::nullopt;
  const VectorXd usual = scale_priors(problem, {}), unexplained = unexplained_scales(problem, fit.cost);
  const MatrixXd prior =
                     scale_information((usual.array().square() + unexplained.array().square()).sqrt(), problem.common),
                 fitted_prior = scale_information(scale_priors(problem, problem.scale_factors), problem.common);
  const MatrixXd posterior = *fitted_information + (prior - fitted_prior);
  const auto covariance = invert_spd(posterior);
  if (!covariance) return std::nullopt;
  const VectorXd right = *fitted_information * (scale_values(fit.unknowns.errors) + global->step(at));
  return ScaleEstimate{*covariance * right, *covariance, prior};
}

/// The scale matrix of each gyroscope and accelerometer; the rotation of each gyroscope against its accelerometer; the
/// factor of all gyroscopes.
std::vector<WideningCandidate> candidates(std::size_t sensors) {
  const Index parameters = each * static_cast<Index>(sensors);
  std::vector<WideningCandidate> all;
  const auto add_candidate = [&](Index unknowns, double largest_sd) -> MatrixXd& {
    return all.emplace_back(WideningCandidate{MatrixXd::Zero(parameters, unknowns), largest_sd}).directions;
  };
  for (Index first = 0; first < parameters; first += elements)
    add_candidate(elements, largest_scale_sd).middleRows(first, elements).setIdentity();
  for (Index first = 0; first < parameters; first += each) {
    MatrixXd& turn = add_candidate(3, largest_scale_sd);
    turn.middleRows(first, elements) = rotations();
    turn.middleRows(first + elements, elements) = -rotations();
  }
  add_candidate(1, largest_common_scale_sd) = common_factor(sensors);
  return all;
}

/// Adds what a widening says; `candidate` as in candidates().
void add(ScaleReview& review, const Widening& widening, std::size_t sensors) {
  const std::size_t matrices = 2 * sensors;
  if (widening.candidate < matrices) {
    const auto instrument = widening.candidate % 2 == 0 ? InsInstrument::gyroscope : InsInstrument::accelerometer;
    review.deviant.push_back({widening.candidate / 2, instrument, widening.sd, widening.log_odds});
  } else if (widening.candidate < matrices + sensors) {
    // Half of the rotation each is what the prior says; all of it may be that of one instrument, about one axis.
    const double whole = 2.0 * std::sqrt(3.0) * widening.sd;
    review.turned.push_back({widening.candidate - matrices, whole, widening.log_odds});
  } else {
    review.common_sd = widening.sd, review.common_log_odds = widening.log_odds;
  }
}

ScaleReview review_scales(const RefinementTask& task, RefinementFit& fitted) {
  ScaleReview review;
  const auto estimate = scale_estimate(task, fitted);
  if (!estimate) return review;
  const std::size_t sensors = fitted.setup.problem.sensors.size();
  for (const Widening& widening : find_widenings(*estimate, candidates(sensors), log_deviant_scale_odds))
    add(review, widening, sensors);
  return review;
}

std::vector<InsScaleFactor> scale_factors(const ScaleReview& review, const InsProblem& problem) {
  const InsErrorPrior& prior = problem.prior;
  std::vector<InsScaleFactor> factors(problem.sensors.size());
  const auto widen = [](double& factor, double sd, double prior_sd) { factor = std::hypot(factor, sd / prior_sd); };
  for (const DeviantScale& scale : review.deviant)
    scale.instrument == InsInstrument::gyroscope
        ? widen(factors[scale.sensor].gyroscope, scale.sd, prior.gyroscope_scale)
        : widen(factors[scale.sensor].accelerometer, scale.sd, prior.accelerometer_scale);
  for (const TurnedAxes& turned : review.turned) {
    widen(factors[turned.sensor].gyroscope, turned.sd, prior.gyroscope_scale);
    widen(factors[turned.sensor].accelerometer, turned.sd, prior.accelerometer_scale);
  }
  for (InsScaleFactor& factor : factors) widen(factor.gyroscope, review.common_sd, prior.gyroscope_scale);
  return factors;
}

/// Whether instruments and clock can have the estimated errors. A factor of the clock leaves all elements of all
/// gyroscopes free: those of axes that turn are estimates.
bool are_possible(const InsProblem& problem, const std::vector<InsErrors>& errors, const ScaleReview& review) {
  for (std::size_t s = 0; s < errors.size(); ++s) {
    const Mat3 &rate = errors[s].gyroscope_scale, &force = errors[s].accelerometer_scale;
    if (review.common_sd <= 0.0) {
      if (std::max(rate.cwiseAbs().maxCoeff(), force.cwiseAbs().maxCoeff()) > largest_scale) return false;
      continue;
    }
    const InsMeasurements& r = problem.sensors[s];
    const Vec3 dilution = regression_dilution(r.angular_velocity, r.noise.angular_velocity);
    for (Index k = 0; k < 3; ++k)
      if (const double factor = 1.0 + rate(k, k);
          dilution[k] < turning_dilution && (factor > largest_common_factor || factor < 1.0 / largest_common_factor))
        return false;
  }
  return true;
}

/// A fit and what fitting changes in its problem; a copy of the problem would hold an hour of measurements twice.
struct FitState {
  InsFit fit;
  std::vector<InsNoise> noise;
};

FitState state_of(const RefinementFit& fitted) {
  FitState state{fitted.fit, {}};
  for (const InsMeasurements& sensor : fitted.setup.problem.sensors) state.noise.push_back(sensor.noise);
  return state;
}

void restore(RefinementFit& fitted, FitState&& state) {
  InsProblem& problem = fitted.setup.problem;
  fitted.fit = std::move(state.fit);
  problem.scale_factors.clear();
  for (std::size_t s = 0; s < state.noise.size(); ++s) problem.sensors[s].noise = state.noise[s];
}

}  // namespace

bool ScaleReview::is_alike(const ScaleReview& other) const {
  return (common_sd > 0.0) == (other.common_sd > 0.0) &&
         std::ranges::is_permutation(deviant, other.deviant,
                                     [](const DeviantScale& a, const DeviantScale& b) {
                                       return a.sensor == b.sensor && a.instrument == b.instrument;
                                     }) &&
         std::ranges::is_permutation(turned, other.turned, {}, &TurnedAxes::sensor, &TurnedAxes::sensor);
}

ScaleReview refit_deviant_scales(const RefinementTask& task, RefinementFit& fitted, const Observer& observer) {
  ScaleReview review;
  InsProblem& problem = fitted.setup.problem;
  if (problem.prior.gyroscope_scale <= 0.0 || problem.prior.accelerometer_scale <= 0.0) return review;
  const bool explains_all = worst_misfit(problem) <= max_rigid_chain_misfit;
  std::optional<FitState> before;
  for (int round = 0; round < most_rounds; ++round) {
    const ScaleReview now = review_scales(task, fitted);
    if (now.empty() || now.is_alike(review)) break;
    if (!before) before = state_of(fitted);
    review = now;
    problem.scale_factors = scale_factors(review, problem);
    fitted.fit = fit_ins(problem, fitted.fit.unknowns, task.options, observer);
    if (!are_possible(problem, fitted.fit.unknowns.errors, review)) break;
  }
  const bool is_explained = explains_all || worst_misfit(problem) <= max_rigid_chain_misfit;
  if (review.empty() || (is_explained && are_possible(problem, fitted.fit.unknowns.errors, review))) return review;
  restore(fitted, std::move(*before));
  return {};
}

}  // namespace kinfer::identify
