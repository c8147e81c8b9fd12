#include "kinfer/calibrate/single_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/calibrate/fleet_prior.hpp"
#include "kinfer/calibrate/frames_start.hpp"
#include "kinfer/calibrate/parameter_choice.hpp"
#include "kinfer/estimate/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

Tolerances scaled(Tolerances tolerances, double factor) {
  for (double* value : {&tolerances.length, &tolerances.angle, &tolerances.tool_length, &tolerances.gain})
    *value *= factor;
  return tolerances;
}

Result<ParameterSet> chosen_parameters(const CalibrateTask& task, const ParameterChoice& choice,
                                       const Tolerances& tolerances) {
  return std::visit(
      Overloaded{[&](const AutoParameters&) -> Result<ParameterSet> {
                   return geometric_parameters(task.nominal, task.data, tolerances);
                 },
                 [&](const Paper24Parameters&) { return paper24_parameters(task.nominal, tolerances); },
                 [&](const NamedParameters& named) { return named_parameters(task.nominal, tolerances, named.names); }},
      choice);
}

bool frees_the_base(const ParameterSet& set) {
  return std::any_of(set.parameters.begin(), set.parameters.end(),
                     [](const Parameter& p) { return p.at.owner == Owner::base; });
}

/// The frame of the file where the data agree with it to three tolerances, else the frame that the data show.
Frame believed_tool(const Frame& file, const Frame& found, double tolerance) {
  Frame tool = found;
  if ((file.xyz - found.xyz).norm() <= 3.0 * tolerance) tool.xyz = file.xyz;
  return tool;
}

/// Whether the data agree with the base of the file to three tolerances.
bool base_is_believed(const CalibrateTask& task, const Chain& found) {
  const Frame &file = task.nominal.base, &data = found.base;
  return (file.xyz - data.xyz).norm() <= 3.0 * task.tolerances.base_length &&
         angle_between(file.pose().rotation, data.pose().rotation) <= 3.0 * task.tolerances.base_angle;
}

/// −2 log of the marginal likelihood, by Laplace's approximation: misfit + level of the noise + price of the freedom
/// used.
double surprise(const Estimate& estimate, const PoseSet& data) {
  const auto points = 3.0 * static_cast<double>(data.points.size());
  const auto turns = 3.0 * static_cast<double>(data.orientations.size());
  double sum = points * std::log(estimate.sigma * estimate.sigma) + estimate.search.cost;
  if (turns > 0.0) sum += turns * std::log(estimate.sigma_angle * estimate.sigma_angle);
  const VectorXd s2 = estimate.identifiability.singular_values.cwiseAbs2();
  return sum + (1.0 + s2.array()).log().sum();
}

double reach(const Chain& chain, const PoseSet& data) {
  double furthest = 0.0;
  const Vec3 base = chain.base.xyz;
  for (const PointMeasurement& point : data.points) furthest = std::max(furthest, (point.position - base).norm());
  return furthest;
}

Chain shaken(const Chain& start, const ParameterSet& set, Rng rng) {
  constexpr double shake_length = 0.1, shake_angle = 20.0 * degree;  // [m], [rad]: METHODS: LM converges from there
  VectorXd x = pack(set, start);
  const auto free = set.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k]->at.owner != Owner::joint) continue;
    if (free[k]->quantity == Quantity::length) x[static_cast<Eigen::Index>(k)] += shake_length * rng.uniform(-1, 1);
    if (free[k]->quantity == Quantity::angle) x[static_cast<Eigen::Index>(k)] += shake_angle * rng.uniform(-1, 1);
  }
  return unpack(set, start, x);
}

bool residuals_exceed_the_instrument(const Estimate& estimate, const CalibrateTask& task) {
  constexpr double by_far = 2.0;  // [sigma]
  const double promised = task.instrument ? task.instrument->sigma : 0.0;
  return estimate.sigma > by_far * promised;
}

}  // namespace

Result<PreparedFit> prepare_fit(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale) {
  const Tolerances tolerances = scaled(task.tolerances, scale.factor);
  KINFER_TRY(set, chosen_parameters(task, choice, tolerances));
  const auto informed = [&](const Chain& start, const ParameterSet& parameters) {
    return PreparedFit{task.earlier ? with_joint_numbers_of(start, *task.earlier, parameters) : start,
                       with_fleet_prior(parameters, task.fleet)};
  };
  KINFER_TRY(found, with_frames_from_data(task.nominal, rows));
  if (!frees_the_base(set)) return informed(base_is_believed(task, found) ? task.nominal : found, set);
  Chain centre = found;
  centre.tool = believed_tool(task.nominal.tool, found.tool, tolerances.tool_length);
  return informed(found, centred_at(set, centre));
}

Result<Chain> fit_frames_only(const CalibrateTask& task, const PoseSet& rows) {
  KINFER_TRY(start, with_frames_from_data(task.nominal, rows));
  ParameterSet frames = centred_at(frame_parameters(task.nominal, rows), start);
  for (Parameter& parameter : frames.parameters) parameter.prior_sd = std::numeric_limits<double>::infinity();
  return fit_bundle(start, frames, rows, task.instrument).chain;
}

Result<Estimate> fit_once(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                          ToleranceScale scale, const Observer& observer) {
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, scale));
  return fit_bundle(prepared.start, prepared.parameters, rows, task.instrument, {}, observer);
}

Result<ScaledFit> fit_with_believable_tolerances(const CalibrateTask& task, const PoseSet& rows,
                                                 const ParameterChoice& choice, Rng rng, const Observer& observer) {
  KINFER_TRY(as_given, fit_once(task, rows, choice, {}, observer));
  ScaledFit best{as_given, {}};
  if (!residuals_exceed_the_instrument(as_given, task)) return best;
  for (const double factor : {10.0, 100.0, 1000.0}) {
    KINFER_TRY(looser, fit_once(task, rows, choice, {factor}, observer));
    if (surprise(looser, rows) < surprise(best.estimate, rows)) best = {looser, {factor}};
  }
  constexpr double lost = 2e-3;  // of the reach: no robot is that wrong once its parameters are found
  constexpr int starts = 20;
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, {1000.0}));
  for (int i = 0; i < starts && best.estimate.sigma > lost * reach(prepared.start, rows); ++i) {
    const Chain start = shaken(prepared.start, prepared.parameters, rng.stream(i));
    const Estimate other = fit_bundle(start, prepared.parameters, rows, task.instrument, {}, observer);
    if (surprise(other, rows) < surprise(best.estimate, rows)) best = {other, {1000.0}};
  }
  return best;
}

}  // namespace kinfer
