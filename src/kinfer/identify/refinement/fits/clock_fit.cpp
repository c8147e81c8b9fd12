// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/clock_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double clock_offset_sd = 0.01;  // [s] error left by the correlation of angular velocities
constexpr double clock_drift_sd = 1e-4;   // [s/s] quartz is within 100 ppm

double squared_rotation(const InsMeasurements& sensor) {
  double sum = 0.0;
  for (const InsBlock& block : sensor.angular_velocity) sum += double{block.target.squaredNorm()};
  return sum;
}

/// [s] Largest absolute shift of a clock over the recording.
double largest_shift(const ClockCorrection& clock, const SplineGrid& grid) {
  return std::max(std::abs(clock.shift_at(grid.begin)), std::abs(clock.shift_at(grid.end())));
}

bool is_significant(const ResidualClock& clock, const SplineGrid& grid, double certainty) {
  const bool by_offset = std::abs(clock.correction.offset) > certainty * clock.offset_sd;
  const bool by_drift = std::abs(clock.correction.drift) > certainty * clock.drift_sd;
  return (by_offset || by_drift) && largest_shift(clock.correction, grid) > min_clock_offset;
}

ClockCorrection correction_of(const InsClock& clock, const SplineGrid& grid) {
  return {clock.offset, clock.drift, 0.5 * (grid.begin + grid.end())};
}

ResidualClock residual_clock(const InsFit& fit, const InsCovariance& covariance, const SplineGrid& grid,
                             std::size_t sensor) {
  const Index at = fit.layout.error[sensor] + fit.layout.clock_error;
  const auto sd = [&](Index k) { return std::sqrt(covariance.model(k, k) * std::max(1.0, covariance.inflation[k])); };
  return {correction_of(fit.unknowns.errors[sensor].clock, grid), sd(at), sd(at + 1)};
}

/// Frees the clocks of a problem in this object's scope and restores clock priors and noise at its end, unless kept.
/// A copy of the problem would hold an hour of measurements twice.
class ScopedFreeClocks {
 public:
  ScopedFreeClocks(InsProblem& problem, const InsBodies& bodies)
      : problem_(problem), prior_(problem.prior), reference_(problem.clock_reference) {
    for (const InsMeasurements& sensor : problem.sensors) noise_.push_back(sensor.noise);
    free_clocks(problem, bodies);
  }
  ScopedFreeClocks(const ScopedFreeClocks&) = delete;
  ScopedFreeClocks& operator=(const ScopedFreeClocks&) = delete;
  ~ScopedFreeClocks() {
    if (kept_) return;
    problem_.prior = prior_;
    problem_.clock_reference = reference_;
    for (std::size_t s = 0; s < noise_.size(); ++s) problem_.sensors[s].noise = noise_[s];
  }
  void keep() { kept_ = true; }

 private:
  InsProblem& problem_;
  InsErrorPrior prior_;
  std::size_t reference_;
  std::vector<InsNoise> noise_;
  bool kept_ = false;
};

}  // namespace

void free_clocks(InsProblem& problem, const InsBodies& bodies) {
  problem.prior.clock_offset = clock_offset_sd;
  problem.prior.clock_drift = clock_drift_sd;
  const auto rotation = [&](const InsBody& body) {
    return body.sensor < 0 ? -1.0 : squared_rotation(problem.sensors[static_cast<std::size_t>(body.sensor)]);
  };
  problem.clock_reference = static_cast<std::size_t>(std::ranges::max_element(bodies, {}, rotation)->sensor);
}

bool clocks_are_doubtful(InsProblem& problem, const InsFit& fit, int threads) {
  const ScopedFreeClocks free(problem, fit.unknowns.bodies);
  InsFit next{.unknowns = {}, .layout = layout_of(problem, fit.unknowns.bodies), .cost = {}};
  const InsSystem system(problem, next.layout, fit.unknowns, {}, threads);
  const auto step = system.solve();
  if (!step) return false;
  next.unknowns = retract(problem, next.layout, fit.unknowns, *step);
  const auto are_suspicious = [&](const std::optional<InsCovariance>& covariance) {
    return covariance &&
           std::ranges::any_of(refined_clocks(problem, next, *covariance), [&](const ResidualClock& clock) {
             return is_significant(clock, problem.grid, clock_suspicion);
           });
  };
  // The sandwich estimator only increases standard deviations and is by far the most expensive step: it comes last.
  return are_suspicious(model_covariance(system)) && are_suspicious(covariance_of(system));
}

void refit_with_free_clocks(InsProblem& problem, InsFit& fit, const InsFitOptions& options, const Observer& observer) {
  ScopedFreeClocks free(problem, fit.unknowns.bodies);
  InsFit trial = fit_ins(problem, fit.unknowns, options, observer);
  const auto covariance = covariance_of(problem, trial.layout, trial.unknowns, options.threads);
  if (!covariance) return;
  const auto clocks = refined_clocks(problem, trial, *covariance);
  if (std::ranges::none_of(
          clocks, [&](const ResidualClock& clock) { return is_significant(clock, problem.grid, clock_certainty); }))
    return;
  free.keep();
  fit = std::move(trial);
}

bool clocks_differ(const SplineGrid& grid, const InsUnknowns& x) {
  return std::ranges::any_of(x.errors, [&](const InsErrors& errors) {
    return largest_shift(correction_of(errors.clock, grid), grid) > max_clock_offset;
  });
}

std::vector<ResidualClock> refined_clocks(const InsProblem& problem, const InsFit& fit,
                                          const InsCovariance& covariance) {
  std::vector<ResidualClock> clocks;
  if (!fit.layout.has_clocks) return clocks;
  for (std::size_t s = 0; s < fit.unknowns.errors.size(); ++s)
    clocks.push_back(residual_clock(fit, covariance, problem.grid, s));
  return clocks;
}

}  // namespace kinfer::identify
