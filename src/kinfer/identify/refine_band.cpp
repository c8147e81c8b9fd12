#include "kinfer/identify/refine_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/estimate/ins_low_band.hpp"
#include "kinfer/identify/loose_hinge.hpp"

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

/// All motion that the recording shows, knots as fine as it allows, for a chain that holds for good.
RefineFit whole_motion(const RefineTask& task, const RefineFit& found) {
  RefineFit whole{continued(task, task.recording, finest_knots, found.setup.problem.grid, found.fit.unknowns), {}};
  InsFitOptions motion_only = task.options;
  motion_only.rounds = 0;
  whole.fit = fit_ins(whole.setup.problem, whole.setup.start, motion_only);
  return whole;
}

RefineFit fit_from(const RefineTask& task, RefineSetup setup) {
  InsFitOptions options = task.options;
  options.iterations = slow_iterations;
  RefineFit result{std::move(setup), {}};
  result.fit = fit_ins(result.setup.problem, result.setup.start, options);
  return result;
}

RefineFit slow_fit(const RefineTask& task, const RefineFit& whole, double cutoff) {
  const InsProblem& fine = whole.setup.problem;
  const InsRecording slow = low_band_readings(task.recording, fine, whole.fit.unknowns, cutoff, task.options.threads);
  InsUnknowns start = whole.fit.unknowns;
  start.band = low_band(start.band, fine.grid, cutoff);
  RefineSetup setup = continued(task, slow, 1.0 / (knots_per_period * cutoff), fine.grid, start);
  for (std::size_t s = 0; s < setup.problem.sensors.size(); ++s)  // smoothed readings hide what their noise is
    setup.problem.sensors[s].noise = setup.problem.sensors[s].least = fine.sensors[s].least;
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

RefineFit with_balls(const RefineTask& task, const RefineFit& fitted, const std::vector<std::size_t>& bodies) {
  RefineSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  for (const std::size_t body : bodies) loosen(setup.start, layout_of(setup.problem, setup.start.bodies), body);
  anchor(setup);
  return fit_from(task, std::move(setup));
}

/// Every hinge that explains notably more as a ball becomes one.
RefineFit loosened(const RefineTask& task, RefineFit fitted, const Observer& observer) {
  std::vector<std::size_t> loose;
  for (std::size_t b = 1; b < fitted.fit.unknowns.bodies.size(); ++b) {
    if (fitted.fit.unknowns.bodies[b].motion != JointMotion::turn) continue;
    say(observer, "loose joints", static_cast<double>(b) / static_cast<double>(fitted.fit.unknowns.bodies.size()));
    const RefineFit ball = with_balls(task, fitted, {b});
    if (log_residual(fitted) - log_residual(ball) > notable_gain) loose.push_back(b);
  }
  return loose.empty() ? fitted : with_balls(task, fitted, loose);
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

std::vector<VectorXd> shifts(const InsBodies& from, const InsBodies& to) {
  std::vector<VectorXd> result;
  for (std::size_t b = 0; b < from.size(); ++b) result.push_back(shift_of(from[b], to[b]));
  return result;
}

/// Σ log of the unknowns' variances, the shift counted as one.
double uncertainty(const RefineTask& task, const SlowMotion& slow) {
  const InsFit& fit = slow.fitted.fit;
  const auto covariance = covariance_of(slow.fitted.setup.problem, fit.layout, fit.unknowns, task.options.threads);
  if (!covariance) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t b = 0; b < slow.shift.size(); ++b)
    for (Index i = 0; i < slow.shift[b].size(); ++i) {
      const Index k = fit.layout.body[b] + i;
      sum += std::log(std::max(1.0, covariance->inflation[k]) * covariance->model(k, k) +
                      slow.shift[b][i] * slow.shift[b][i]);
    }
  return sum;
}

}  // namespace

SlowMotion fit_slow_motion(const RefineTask& task, const RefineFit& found, const Observer& observer) {
  RefineFit fitted = slow_fit(task, whole_motion(task, found), trial_cutoff);
  if (task.facts.places.empty()) fitted = loosened(task, std::move(fitted), observer);
  const RefineFit whole = whole_motion(task, fitted);
  RefineFit wider = slow_fit(task, whole, cutoffs.front());
  std::optional<SlowMotion> best;
  double least = 0.0;
  for (std::size_t i = 1; i < cutoffs.size(); ++i) {
    say(observer, "slow motion", static_cast<double>(i) / static_cast<double>(cutoffs.size()));
    RefineFit now = slow_fit(task, whole, cutoffs[i]);
    SlowMotion slow{now, cutoffs[i], shifts(now.fit.unknowns.bodies, wider.fit.unknowns.bodies), {}};
    const double sum = uncertainty(task, slow);
    if (best && sum >= least) break;
    best = std::move(slow);
    least = sum;
    wider = std::move(now);
  }
  for (const InsReadings& readings : whole.setup.problem.sensors) best->noise.push_back(readings.noise);
  return std::move(*best);
}

}  // namespace kinfer
