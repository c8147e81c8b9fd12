#include "kinfer/identify/refine_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/estimate/ins_low_band.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/loose_hinge.hpp"
#include "kinfer/identify/yielding_mounts.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double finest_knots = 0.025;     // [s]
constexpr double knots_per_period = 10.0;  // of the cutoff's: what is left of waves at twice the cutoff needs five each
constexpr int slow_iterations = 8;
constexpr std::array cutoffs{2.0, 1.4, 1.0, 0.7};  // [Hz] widest first
constexpr double trial_cutoff = 1.0;               // [Hz] for telling which joints are loose
// In the sum of log residuals. Two channels more absorb 0.35 of it; to be worth their description (Schwarz 1978) on a
// minute of slow motion they need about 2.
constexpr double notable_gain = 2.0;

MatrixXd band_on(const SplineGrid& to, const SplineGrid& from, ConstMatrixRef band) {
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

/// A constant of a joint's reading that no signal tells stays where it is.
void anchor(RefineSetup& setup) {
  setup.problem.anchor.clear();
  for (Index k = setup.problem.root_stands_still ? 0 : 6; k < setup.start.band.rows(); ++k)
    setup.problem.anchor.push_back(setup.start.band(k, 0));
}

void say(const Observer& observer, const char* stage, double fraction) {
  tell(observer, {.stage = stage, .fraction = fraction, .best = 0.0, .median = 0.0, .iteration = 0, .detail = {}});
}

/// The setup of a recording of the same machine, started where another fit ended.
RefineSetup continued(const RefineTask& task, const InsRecording& recording, double knots, const SplineGrid& grid,
                      const InsUnknowns& found) {
  RefineSetup setup = refine_setup(recording, task.motion, task.tree, task.starts, task.grade, knots);
  setup.problem.facts = task.facts;
  setup.start = found;
  for (InsErrors& errors : setup.start.errors) errors.clock = {};  // small enough to be left alone here
  setup.start.band = band_on(setup.problem.grid, grid, found.band);
  anchor(setup);
  return setup;
}

/// The motion of a chain that holds for good.
InsFit motion_alone(const RefineTask& task, RefineSetup& setup) {
  InsFitOptions motion_only = task.options;
  motion_only.rounds = 0;
  return fit_ins(setup.problem, setup.start, motion_only);
}

/// All motion that the recording shows, knots as fine as it allows.
RefineFit whole_motion(const RefineTask& task, const RefineFit& found) {
  RefineFit whole{continued(task, task.recording, finest_knots, found.setup.problem.grid, found.fit.unknowns), {}};
  whole.fit = motion_alone(task, whole.setup);
  return whole;
}

RefineFit fit_from(const RefineTask& task, RefineSetup setup) {
  InsFitOptions options = task.options;
  options.iterations = slow_iterations;
  RefineFit result{std::move(setup), {}};
  result.fit = fit_ins(result.setup.problem, result.setup.start, options);
  return result;
}

/// Fitted again from where it ended, `change` made to its setup.
template <class Change>
RefineFit fitted_again(const RefineTask& task, const RefineFit& fitted, Change change) {
  RefineSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  change(setup);
  return fit_from(task, std::move(setup));
}

/// Mounts that may give way by so much. What they do outweighs the scale errors by far, which stay as they are: half of
/// the border.
void free_tilts(InsProblem& problem, const InsRecording& recording, double tilt) {
  problem.prior.tilt = tilt;
  problem.prior.rate_matrix = problem.prior.force_matrix = 0.0;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s)
    problem.sensors[s].bending =
        mount_bending(recording.sensors[s], recording.time(recording.sensors[s]), problem.grid);
}

RefineFit slow_fit(const RefineTask& task, const RefineFit& whole, double cutoff, double tilt) {
  const InsProblem& fine = whole.setup.problem;
  const InsRecording slow = low_band_readings(task.recording, fine, whole.fit.unknowns, cutoff, task.options.threads);
  InsUnknowns start = whole.fit.unknowns;
  start.band = low_band(start.band, fine.grid, cutoff);
  RefineSetup setup = continued(task, slow, 1.0 / (knots_per_period * cutoff), fine.grid, start);
  for (std::size_t s = 0; s < setup.problem.sensors.size(); ++s)  // smoothed readings hide what their noise is
    setup.problem.sensors[s].noise = setup.problem.sensors[s].least = fine.sensors[s].least;
  free_tilts(setup.problem, slow, tilt);
  return fit_from(task, std::move(setup));
}

/// Σ log of what the instruments leave unexplained, spikes counted little.
double log_residual(const RefineFit& fitted) {
  double sum = 0.0;
  const auto add = [&](double noise, const InstrumentFit& fit) {
    if (fit.terms > 0.0) sum += std::log(noise * std::sqrt(fit.squares / fit.terms));
  };
  for (std::size_t s = 0; s < fitted.setup.problem.sensors.size(); ++s) {
    const InsNoise& noise = fitted.setup.problem.sensors[s].noise;
    add(noise.rate, fitted.fit.cost.sensors[s].rate);
    add(noise.force, fitted.fit.cost.sensors[s].force);
  }
  return sum;
}

RefineSetup with_balls(const RefineFit& fitted, const std::vector<std::size_t>& bodies) {
  RefineSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  for (const std::size_t body : bodies) loosen(setup.start, layout_of(setup.problem, setup.start.bodies), body);
  anchor(setup);
  return setup;
}

/// What a ball in place of a hinge explains more, the geometry held.
double gain_of_ball(const RefineTask& task, const RefineFit& fitted, std::size_t body) {
  RefineFit ball{with_balls(fitted, {body}), {}};
  ball.fit = motion_alone(task, ball.setup);
  return log_residual(fitted) - log_residual(ball);
}

/// Hinges whose ball explains notably more, and more than those of the others do: what all of them show is the mounts'.
std::vector<std::size_t> loose_ones(const std::vector<std::size_t>& hinges, const std::vector<double>& gains) {
  constexpr double above = 1.3;
  std::vector<std::size_t> loose;
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    std::vector<double> others = gains;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (gains[i] > notable_gain && (others.empty() || gains[i] > above * median(others))) loose.push_back(hinges[i]);
  }
  return loose;
}

/// Hinges that are none become balls.
RefineFit loosened(const RefineTask& task, RefineFit fitted, const Observer& observer) {
  std::vector<std::size_t> hinges;
  std::vector<double> gains;
  for (std::size_t b = 1; b < fitted.fit.unknowns.bodies.size(); ++b) {
    if (fitted.fit.unknowns.bodies[b].motion != JointMotion::turn) continue;
    say(observer, "loose joints", static_cast<double>(b) / static_cast<double>(fitted.fit.unknowns.bodies.size()));
    hinges.push_back(b);
    gains.push_back(gain_of_ball(task, fitted, b));
  }
  const auto loose = loose_ones(hinges, gains);
  return loose.empty() ? fitted : fit_from(task, with_balls(fitted, loose));
}

/// What the mounts' tilts are believed to be, as the fit shows them.
double believed_tilt(const RefineTask& task, const RefineFit& fitted) {
  const InsProblem& problem = fitted.setup.problem;
  const auto covariance = covariance_of(problem, fitted.fit.layout, fitted.fit.unknowns, task.options.threads);
  return covariance ? shown_tilt(problem, fitted.fit, *covariance) : problem.prior.tilt;
}

/// Unknowns of a body that lead from one state of it to another.
VectorXd shift_of(const InsBody& from, const InsBody& to) {
  VectorXd shift(from.unknowns());
  Index k = 0;
  const auto turn = [&](const Mat3& a, const Mat3& b, const std::array<bool, 3>& is_free) {
    const Vec3 v = log_so3(a.transpose() * b);
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) shift[k++] = v[static_cast<Index>(i)];
  };
  turn(from.parent_R_axis, to.parent_R_axis, from.free_parent_turn);
  turn(from.child_R_axis, to.child_R_axis, from.free_child_turn);
  if (from.free_point_in_parent) shift.segment<3>(k) = to.point_in_parent - from.point_in_parent, k += 3;
  if (from.free_point_in_child) shift.segment<3>(k) = to.point_in_child - from.point_in_child;
  return shift;
}

std::vector<MatrixXd> shifts(const InsBodies& from, const InsBodies& to) {
  std::vector<MatrixXd> result;
  for (std::size_t b = 0; b < from.size(); ++b) result.push_back(shift_of(from[b], to[b]));
  return result;
}

/// Σ log of the unknowns' variances, the shift counted as one.
double uncertainty(const RefineTask& task, const RefineFit& slow, const std::vector<MatrixXd>& shift) {
  const InsFit& fit = slow.fit;
  const auto covariance = covariance_of(slow.setup.problem, fit.layout, fit.unknowns, task.options.threads);
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

/// The fit on mounts that do not give way.
RefineFit on_firm_mounts(const RefineTask& task, const RefineFit& fitted) {
  return fitted_again(task, fitted, [](RefineSetup& setup) {
    setup.problem.prior.tilt = 0.0;
    for (InsErrors& errors : setup.start.errors) errors.tilt.setZero();
  });
}

/// [rad] rms that a mount leans.
double lean_of(const Mat3& tilt, const std::vector<InsBending>& bending) {
  double squares = 0.0;
  for (const InsBending& b : bending)
    for (std::size_t node = 0; node < block_nodes; ++node) squares += (tilt * b.force_at(node)).squaredNorm();
  return std::sqrt(squares / static_cast<double>(bending.size() * block_nodes));
}

/// Adds what the mounts do beyond their tilts. These leave a share of the amplitude that firm mounts leave; the rest
/// shifts the geometry by so much less, and is so much less in step with the motion, else it were explained.
void doubt_mounts(const RefineTask& task, const RefineFit& fitted, ModelError& error) {
  const RefineFit firm = on_firm_mounts(task, fitted);
  const std::vector<InsReadings>& sensors = fitted.setup.problem.sensors;
  const double instruments = 2.0 * static_cast<double>(sensors.size());
  const double rest = std::min(1.0, std::exp((log_residual(fitted) - log_residual(firm)) / instruments));
  const auto shift = shifts(fitted.fit.unknowns.bodies, firm.fit.unknowns.bodies);
  for (std::size_t b = 0; b < shift.size(); ++b) {
    error.shift[b].conservativeResize(Eigen::NoChange, error.shift[b].cols() + 1);
    error.shift[b].rightCols<1>() = rest * rest * shift[b];
  }
  for (std::size_t s = 0; s < sensors.size(); ++s)
    error.lean.push_back(rest * lean_of(fitted.fit.unknowns.errors[s].tilt, sensors[s].bending));
}

/// Of the slow motions below several cutoffs the one that tells most.
SlowMotion surest(const RefineTask& task, const RefineFit& whole, double tilt, const Observer& observer) {
  RefineFit wider = slow_fit(task, whole, cutoffs.front(), tilt);
  std::optional<SlowMotion> best;
  double least = 0.0;
  for (std::size_t i = 1; i < cutoffs.size(); ++i) {
    say(observer, "slow motion", static_cast<double>(i) / static_cast<double>(cutoffs.size()));
    RefineFit now = slow_fit(task, whole, cutoffs[i], tilt);
    auto shift = shifts(now.fit.unknowns.bodies, wider.fit.unknowns.bodies);
    const double sum = uncertainty(task, now, shift);
    if (best && sum >= least) break;
    best = SlowMotion{now, cutoffs[i], {std::move(shift), {}}, {}};
    least = sum;
    wider = std::move(now);
  }
  return std::move(*best);
}

}  // namespace

SlowMotion fit_slow_motion(const RefineTask& task, const RefineFit& found, const Observer& observer) {
  RefineFit fitted = slow_fit(task, whole_motion(task, found), trial_cutoff, unknown_tilt);
  const double first = believed_tilt(task, fitted);
  fitted = fitted_again(task, fitted, [&](RefineSetup& setup) { setup.problem.prior.tilt = first; });
  const double tilt = believed_tilt(task, fitted);
  if (task.facts.places.empty()) fitted = loosened(task, std::move(fitted), observer);
  const RefineFit whole = whole_motion(task, fitted);
  SlowMotion slow = surest(task, whole, tilt, observer);
  doubt_mounts(task, slow.fitted, slow.error);
  slow.fitted = fitted_again(task, slow.fitted, [&](RefineSetup& setup) {  // the scale errors are unknowns again
    setup.problem.prior.rate_matrix = whole.setup.problem.prior.rate_matrix;
    setup.problem.prior.force_matrix = whole.setup.problem.prior.force_matrix;
  });
  for (const InsReadings& readings : whole.setup.problem.sensors) slow.noise.push_back(readings.noise);
  return slow;
}

}  // namespace kinfer
