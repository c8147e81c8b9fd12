// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/low_frequency_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kinfer/estimate/continuous/low_frequency.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/identify/refinement/fits/joint_relaxation.hpp"
#include "kinfer/identify/refinement/fits/mount_compliance.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double knots_per_period = 10.0;  // of the cutoff: what remains of waves at twice the cutoff needs five each
constexpr std::array cutoffs{2.0, 1.4, 1.0, 0.7};  // [Hz] widest first

/// Frees the compliance of the mounts, with this prior sd. Its effects outweigh those of the scale errors by far; these
/// are held fixed, which halves the number of global parameters.
void free_mount_compliance(InsProblem& problem, const InsRecording& recording, double tilt) {
  problem.prior.tilt = tilt;
  problem.prior.gyroscope_scale = problem.prior.accelerometer_scale = 0.0;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s)
    problem.sensors[s].mount_load =
        mount_loads(recording.sensors[s], recording.time(recording.sensors[s]), problem.grid);
}

RefinementFit fit_below_cutoff(const RefinementTask& task, const RefinementFit& full_bandwidth, double cutoff,
                               double tilt) {
  const InsProblem& fine = full_bandwidth.setup.problem;
  const InsRecording low_frequency =
      low_frequency_measurements(task.recording, fine, full_bandwidth.fit.unknowns, cutoff, task.options.threads);
  InsUnknowns start = full_bandwidth.fit.unknowns;
  start.spline_coefficients = low_frequency_motion(start.spline_coefficients, fine.grid, cutoff);
  RefinementSetup setup = continue_from(task, low_frequency, 1.0 / (knots_per_period * cutoff), fine, start);
  for (std::size_t s = 0; s < setup.problem.sensors.size(); ++s)  // smoothed measurements do not show their noise
    setup.problem.sensors[s].noise = setup.problem.sensors[s].noise_floor = fine.sensors[s].noise_floor;
  for (InsMeasurements& sensor : setup.problem.sensors)  // slow motion stays below the range that fast motion exceeds
    sensor.clipped_rate = sensor.clipped_force = {};
  free_mount_compliance(setup.problem, low_frequency, tilt);
  return fit_from(task, std::move(setup));
}

/// Standard deviation of the mounts' compliance, estimated from the fit.
double estimated_compliance(const RefinementTask& task, const RefinementFit& fitted) {
  const InsProblem& problem = fitted.setup.problem;
  const auto covariance = covariance_of(problem, fitted.fit.layout, fitted.fit.unknowns, task.options.threads);
  return covariance ? estimate_mount_compliance(problem, fitted.fit, *covariance) : problem.prior.tilt;
}

/// Σ log of the unknowns' variances, the squared shift added to each.
double log_uncertainty(const RefinementTask& task, const RefinementFit& low_frequency,
                       const std::vector<MatrixXd>& shift) {
  const InsFit& fit = low_frequency.fit;
  const auto covariance = covariance_of(low_frequency.setup.problem, fit.layout, fit.unknowns, task.options.threads);
  if (!covariance) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t b = 0; b < shift.size(); ++b)
    for (Index i = 0; i < shift[b].rows(); ++i) {
      const Index k = fit.layout.body[b] + i;
      sum +=
          std::log(std::max(1.0, covariance->inflation[k]) * covariance->model(k, k) + shift[b].row(i).squaredNorm());
    }
  return sum;
}

/// The fit with rigid mounts.
RefinementFit fit_with_rigid_mounts(const RefinementTask& task, const RefinementFit& fitted) {
  return refit_with(task, fitted, [](RefinementSetup& setup) {
    setup.problem.prior.tilt = 0.0;
    for (InsErrors& errors : setup.start.errors) errors.tilt.setZero();
  });
}

/// [rad] rms deflection of a mount.
double rms_deflection(const Mat3& tilt, const std::vector<InsMountLoad>& mount_load) {
  double squares = 0.0;
  for (const InsMountLoad& b : mount_load)
    for (std::size_t node = 0; node < block_nodes; ++node) squares += (tilt * b.force_at(node)).squaredNorm();
  return std::sqrt(squares / static_cast<double>(mount_load.size() * block_nodes));
}

/// Adds the error of the mount model. Compliance leaves a fraction, `rest`, of the residual amplitude of rigid mounts.
/// The unexplained deflection shifts the geometry less by this factor, and once more by it because it is less in phase
/// with the motion; otherwise compliance would explain it.
void add_mount_error(const RefinementTask& task, const RefinementFit& fitted, ModelError& error) {
  const RefinementFit rigid = fit_with_rigid_mounts(task, fitted);
  const std::vector<InsMeasurements>& sensors = fitted.setup.problem.sensors;
  const double instruments = 2.0 * static_cast<double>(sensors.size());
  const double rest = std::min(1.0, std::exp((log_residual(fitted) - log_residual(rigid)) / instruments));
  const auto shift = shifts(fitted.fit.unknowns.bodies, rigid.fit.unknowns.bodies);
  for (std::size_t b = 0; b < shift.size(); ++b) {
    error.shift[b].conservativeResize(Eigen::NoChange, error.shift[b].cols() + 1);
    error.shift[b].rightCols<1>() = rest * rest * shift[b];
  }
  for (std::size_t s = 0; s < sensors.size(); ++s)
    error.mount_deflection.push_back(rest * rms_deflection(fitted.fit.unknowns.errors[s].tilt, sensors[s].mount_load));
}

/// Of the low-frequency fits below several cutoffs, the one of least uncertainty.
LowFrequencyFit select_cutoff(const RefinementTask& task, const RefinementFit& full_bandwidth, double tilt,
                              const Observer& observer) {
  RefinementFit wider = fit_below_cutoff(task, full_bandwidth, cutoffs.front(), tilt);
  std::optional<LowFrequencyFit> best;
  double least_uncertainty = 0.0;
  for (std::size_t i = 1; i < cutoffs.size(); ++i) {
    report_progress(observer, "slow motion", static_cast<double>(i) / static_cast<double>(cutoffs.size()));
    RefinementFit now = fit_below_cutoff(task, full_bandwidth, cutoffs[i], tilt);
    auto shift = shifts(now.fit.unknowns.bodies, wider.fit.unknowns.bodies);
    const double sum = log_uncertainty(task, now, shift);
    if (best && sum >= least_uncertainty) break;
    best = LowFrequencyFit{now, cutoffs[i], {std::move(shift), {}}, {}, {}};
    least_uncertainty = sum;
    wider = std::move(now);
  }
  return std::move(*best);
}

}  // namespace

LowFrequencyFit fit_low_frequency(const RefinementTask& task, const RefinementFit& found, const Observer& observer) {
  RefinementFit fitted = fit_below_cutoff(task, fit_whole_motion(task, found), trial_cutoff, unknown_mount_compliance);
  const double first = estimated_compliance(task, fitted);
  fitted = refit_with(task, fitted, [&](RefinementSetup& setup) { setup.problem.prior.tilt = first; });
  const double tilt = estimated_compliance(task, fitted);
  if (task.facts.places.empty()) fitted = relax_joints(task, std::move(fitted), observer);
  const RefinementFit full_bandwidth = fit_whole_motion(task, fitted);
  LowFrequencyFit low_frequency = select_cutoff(task, full_bandwidth, tilt, observer);
  add_mount_error(task, low_frequency.fitted, low_frequency.error);
  low_frequency.fitted =
      refit_with(task, low_frequency.fitted, [&](RefinementSetup& setup) {  // estimates the scale errors again
        setup.problem.prior.gyroscope_scale = full_bandwidth.setup.problem.prior.gyroscope_scale;
        setup.problem.prior.accelerometer_scale = full_bandwidth.setup.problem.prior.accelerometer_scale;
      });
  for (const InsMeasurements& sensor : full_bandwidth.setup.problem.sensors) {
    low_frequency.noise.push_back(sensor.noise);
    low_frequency.noise_floor.push_back(sensor.noise_floor);
  }
  return low_frequency;
}

}  // namespace kinfer::identify
