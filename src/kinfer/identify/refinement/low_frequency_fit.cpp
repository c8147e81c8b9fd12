// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/low_frequency_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kinfer/estimate/continuous/low_frequency.hpp"
#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/refinement/mount_compliance.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr double finest_knot_spacing = 0.025;  // [s] knot spacing
constexpr double knots_per_period = 10.0;  // of the cutoff: what remains of waves at twice the cutoff needs five each
constexpr int low_frequency_iterations = 8;
constexpr std::array cutoffs{2.0, 1.4, 1.0, 0.7};  // [Hz] widest first
constexpr double trial_cutoff = 1.0;               // [Hz] for deciding which joints are relaxed
// In the sum of log residuals. Two additional spline dimensions absorb 0.35 of it by chance; to be justified by the
// Bayesian information criterion (Schwarz 1978) on a minute of low-frequency motion they need about 2.
constexpr double min_relaxation_gain = 2.0;

MatrixXd resample_spline(const SplineGrid& to, const SplineGrid& from, ConstMatrixRef band) {
  const double step = 0.5 * std::min(to.period, from.period);
  const auto count = static_cast<std::size_t>((from.end() - from.begin) / step);
  std::vector<double> time;
  MatrixXd values(static_cast<Index>(count) + 1, band.rows());
  for (std::size_t i = 0; i <= count; ++i) {
    time.push_back(from.begin + step * static_cast<double>(i));
    values.row(static_cast<Index>(i)) = spline_value(from, band, time.back()).transpose();
  }
  return fit_spline(to, time, values);
}

/// Anchors the joint positions at their current values: keeps an unobservable constant of them where it is.
void anchor(RefinementSetup& setup) {
  setup.problem.anchor.clear();
  for (Index k = setup.problem.root_at_rest ? 0 : 6; k < setup.start.spline_coefficients.rows(); ++k)
    setup.problem.anchor.push_back(setup.start.spline_coefficients(k, 0));
}

void report_progress(const Observer& observer, const char* stage, double fraction) {
  notify(observer, {.stage = stage, .fraction = fraction, .best = 0.0, .median = 0.0, .iteration = 0, .detail = {}});
}

/// The set-up for a recording of the same machine, starting from another fit's result.
RefinementSetup continue_from(const RefinementTask& task, const InsRecording& recording, double knot_spacing,
                              const SplineGrid& grid, const InsUnknowns& found) {
  RefinementSetup setup = set_up_refinement(recording, task.motion, task.tree, task.starts, task.grade, knot_spacing);
  setup.problem.facts = task.facts;
  setup.start = found;
  for (InsErrors& errors : setup.start.errors) errors.clock = {};  // small enough to be neglected here
  setup.start.spline_coefficients = resample_spline(setup.problem.grid, grid, found.spline_coefficients);
  anchor(setup);
  return setup;
}

/// Fits the motion alone, the chain held fixed.
InsFit fit_motion_only(const RefinementTask& task, RefinementSetup& setup) {
  InsFitOptions motion_only = task.options;
  motion_only.reweighting_rounds = 0;
  return fit_ins(setup.problem, setup.start, motion_only);
}

/// The motion at full bandwidth, on the finest knots.
RefinementFit fit_whole_motion(const RefinementTask& task, const RefinementFit& found) {
  RefinementFit full_bandwidth{
      continue_from(task, task.recording, finest_knot_spacing, found.setup.problem.grid, found.fit.unknowns), {}};
  full_bandwidth.fit = fit_motion_only(task, full_bandwidth.setup);
  return full_bandwidth;
}

RefinementFit fit_from(const RefinementTask& task, RefinementSetup setup) {
  InsFitOptions options = task.options;
  options.iterations = low_frequency_iterations;
  RefinementFit result{std::move(setup), {}};
  result.fit = fit_ins(result.setup.problem, result.setup.start, options);
  return result;
}

/// Fits again from the result, after `change` of the set-up.
template <class Change>
RefinementFit refit_with(const RefinementTask& task, const RefinementFit& fitted, Change change) {
  RefinementSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  change(setup);
  return fit_from(task, std::move(setup));
}

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
  RefinementSetup setup = continue_from(task, low_frequency, 1.0 / (knots_per_period * cutoff), fine.grid, start);
  for (std::size_t s = 0; s < setup.problem.sensors.size(); ++s)  // smoothed measurements do not show their noise
    setup.problem.sensors[s].noise = setup.problem.sensors[s].noise_floor = fine.sensors[s].noise_floor;
  free_mount_compliance(setup.problem, low_frequency, tilt);
  return fit_from(task, std::move(setup));
}

/// Σ log of the instruments' residual noise; outliers have little weight.
double log_residual(const RefinementFit& fitted) {
  double sum = 0.0;
  const auto add = [&](double noise, const InstrumentFit& fit) {
    if (fit.terms > 0.0) sum += std::log(noise * std::sqrt(fit.squares / fit.terms));
  };
  for (std::size_t s = 0; s < fitted.setup.problem.sensors.size(); ++s) {
    const InsNoise& noise = fitted.setup.problem.sensors[s].noise;
    add(noise.angular_velocity, fitted.fit.cost.sensors[s].angular_velocity);
    add(noise.force, fitted.fit.cost.sensors[s].force);
  }
  return sum;
}

RefinementSetup relaxed_setup(const RefinementFit& fitted, const std::vector<std::size_t>& bodies) {
  RefinementSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  for (const std::size_t body : bodies)
    relax_to_spherical(setup.start, layout_of(setup.problem, setup.start.bodies), body);
  anchor(setup);
  return setup;
}

/// Decrease of the log residual when a revolute joint is relaxed to a spherical one, the geometry held fixed.
double relaxation_gain(const RefinementTask& task, const RefinementFit& fitted, std::size_t body) {
  RefinementFit ball{relaxed_setup(fitted, {body}), {}};
  ball.fit = fit_motion_only(task, ball.setup);
  return log_residual(fitted) - log_residual(ball);
}

/// Revolute joints whose relaxation explains significantly more, and more than that of the others: what all of them
/// show comes from the mounts.
std::vector<std::size_t> select_joints_to_relax(const std::vector<std::size_t>& hinges,
                                                const std::vector<double>& gains) {
  constexpr double min_ratio_to_others = 1.3;
  std::vector<std::size_t> to_relax;
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    std::vector<double> others = gains;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (gains[i] > min_relaxation_gain && (others.empty() || gains[i] > min_ratio_to_others * median(others)))
      to_relax.push_back(hinges[i]);
  }
  return to_relax;
}

/// Relaxes the joints that are not strictly revolute to spherical ones.
RefinementFit relax_joints(const RefinementTask& task, RefinementFit fitted, const Observer& observer) {
  std::vector<std::size_t> hinges;
  std::vector<double> gains;
  for (std::size_t b = 1; b < fitted.fit.unknowns.bodies.size(); ++b) {
    if (fitted.fit.unknowns.bodies[b].motion != JointMotion::revolute) continue;
    report_progress(observer, "loose joints",
                    static_cast<double>(b) / static_cast<double>(fitted.fit.unknowns.bodies.size()));
    hinges.push_back(b);
    gains.push_back(relaxation_gain(task, fitted, b));
  }
  const auto to_relax = select_joints_to_relax(hinges, gains);
  return to_relax.empty() ? fitted : fit_from(task, relaxed_setup(fitted, to_relax));
}

/// Standard deviation of the mounts' compliance, estimated from the fit.
double estimated_compliance(const RefinementTask& task, const RefinementFit& fitted) {
  const InsProblem& problem = fitted.setup.problem;
  const auto covariance = covariance_of(problem, fitted.fit.layout, fitted.fit.unknowns, task.options.threads);
  return covariance ? estimate_mount_compliance(problem, fitted.fit, *covariance) : problem.prior.tilt;
}

/// The step in a body's unknowns from one estimate of it to another.
VectorXd shift_of(const InsBody& from, const InsBody& to) {
  VectorXd shift(from.unknowns());
  Index k = 0;
  const auto turn = [&](const Mat3& a, const Mat3& b, const std::array<bool, 3>& is_free) {
    const Vec3 v = log_so3(a.transpose() * b);
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) shift[k++] = v[static_cast<Index>(i)];
  };
  turn(from.parent_R_axis, to.parent_R_axis, from.free_parent_rotation);
  turn(from.child_R_axis, to.child_R_axis, from.free_child_rotation);
  if (from.free_point_in_parent) shift.segment<3>(k) = to.point_in_parent - from.point_in_parent, k += 3;
  if (from.free_point_in_child) shift.segment<3>(k) = to.point_in_child - from.point_in_child;
  return shift;
}

std::vector<MatrixXd> shifts(const InsBodies& from, const InsBodies& to) {
  std::vector<MatrixXd> result;
  for (std::size_t b = 0; b < from.size(); ++b) result.push_back(shift_of(from[b], to[b]));
  return result;
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
    best = LowFrequencyFit{now, cutoffs[i], {std::move(shift), {}}, {}};
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
  for (const InsMeasurements& readings : full_bandwidth.setup.problem.sensors)
    low_frequency.noise.push_back(readings.noise);
  return low_frequency;
}

}  // namespace kinfer::identify
