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

/// Contacts alone tell no lengths but by their ratios: a robot half as large would fit them twice as well. There the
/// tolerances of lengths stay as they are.
bool lengths_are_measured(const CalibrateTask& task) {
  const PoseSet& data = task.data;
  return data.points.size() + data.distances.size() + data.pairs.size() > 0 ||
         !task.nominal.surroundings.socket_distances.empty();
}

Tolerances scaled(const CalibrateTask& task, double factor) {
  Tolerances tolerances = task.tolerances;
  for (double* value : {&tolerances.angle, &tolerances.gain}) *value *= factor;
  if (lengths_are_measured(task))
    for (double* value : {&tolerances.length, &tolerances.tool_length}) *value *= factor;
  return tolerances;
}

Result<ParameterSet> chosen_parameters(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                       const Tolerances& tolerances) {
  auto set = std::visit(
      Overloaded{[&](const AutoParameters&) -> Result<ParameterSet> {
                   return geometric_parameters(task.nominal, rows, tolerances);
                 },
                 [&](const OffsetParameters&) -> Result<ParameterSet> {
                   return offset_parameters(task.nominal, rows, tolerances);
                 },
                 [&](const Paper24Parameters&) { return paper24_parameters(task.nominal, tolerances); },
                 [&](const NamedParameters& named) { return named_parameters(task.nominal, tolerances, named.names); }},
      choice);
  if (set) set->parameters.insert(set->parameters.end(), task.further.begin(), task.further.end());
  return set;
}

bool frees_frames(const ParameterSet& set, const ParameterChoice& choice) {
  return std::holds_alternative<AutoParameters>(choice) || std::holds_alternative<OffsetParameters>(choice) ||
         std::any_of(set.parameters.begin(), set.parameters.end(),
                     [](const Parameter& p) { return p.at.owner == Owner::base; });
}

/// The frame of the file where the data agree with it to three tolerances, else the frame that the data show.
Frame believed_tool(const Frame& file, const Frame& found, double tolerance) {
  Frame tool = found;
  if ((file.xyz - found.xyz).norm() <= 3.0 * tolerance) tool.xyz = file.xyz;
  return tool;
}

/// Where the priors lie: base, sockets and planes where the data show them; tools where the file has them, if the data
/// agree; anchors and gravity as in the file.
Chain prior_centre(const Chain& nominal, const Chain& found, const Tolerances& tolerances) {
  Chain centre = found;
  centre.tool = believed_tool(nominal.tool, found.tool, tolerances.tool_length);
  for (std::size_t m = 0; m < centre.mountings.size(); ++m)
    centre.mountings[m].tool =
        believed_tool(nominal.mountings[m].tool, found.mountings[m].tool, tolerances.tool_length);
  centre.surroundings.anchors = nominal.surroundings.anchors;
  centre.gravity = nominal.gravity;
  return centre;
}

/// Whether the data agree with the base of the file to three tolerances.
bool base_is_believed(const CalibrateTask& task, const Chain& found) {
  const Frame &file = task.nominal.base, &data = found.base;
  return (file.xyz - data.xyz).norm() <= 3.0 * task.tolerances.base_length &&
         angle_between(file.pose().rotation, data.pose().rotation) <= 3.0 * task.tolerances.base_angle;
}

double reach(const Chain& chain, const PoseSet& data) {
  double furthest = 0.0;
  for (const Pose& pose : evaluate_poses(chain, {}, data, Derivative::no).pose)
    furthest = std::max(furthest, (pose.position - chain.base.xyz).norm());
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
  const Tolerances tolerances = scaled(task, scale.factor);
  KINFER_TRY(set, chosen_parameters(task, rows, choice, tolerances));
  const auto informed = [&](const Chain& start, const ParameterSet& parameters) {
    return PreparedFit{task.earlier ? with_joint_numbers_of(start, *task.earlier, parameters) : start,
                       with_fleet_prior(parameters, task.fleet)};
  };
  KINFER_TRY(found, with_frames_from_data(task.nominal, rows));
  if (!frees_frames(set, choice)) return informed(base_is_believed(task, found) ? task.nominal : found, set);
  // A knocked robot hides where its tool is until the offsets are known: the earlier tool is believed longer.
  Tolerances believable = tolerances;
  if (std::holds_alternative<OffsetParameters>(choice)) believable.tool_length *= 10.0;
  return informed(found, centred_at(set, prior_centre(task.nominal, found, believable)));
}

Result<Chain> fit_frames_only(const CalibrateTask& task, const PoseSet& rows) {
  KINFER_TRY(start, with_frames_from_data(task.nominal, rows));
  Chain centre = start;
  centre.surroundings.anchors = task.nominal.surroundings.anchors;
  centre.gravity = task.nominal.gravity;
  const ParameterSet frames = centred_at(frame_parameters(task.nominal, rows, task.tolerances), centre);
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
    if (looser.surprise < best.estimate.surprise) best = {looser, {factor}};
  }
  constexpr double lost = 2e-3;  // of the reach: no robot is that wrong once its parameters are found
  constexpr int starts = 20;
  KINFER_TRY(prepared, prepare_fit(task, rows, choice, {1000.0}));
  for (int i = 0; i < starts && best.estimate.sigma > lost * reach(prepared.start, rows); ++i) {
    const Chain start = shaken(prepared.start, prepared.parameters, rng.stream(i));
    const Estimate other = fit_bundle(start, prepared.parameters, rows, task.instrument, {}, observer);
    if (other.surprise < best.estimate.surprise) best = {other, {1000.0}};
  }
  return best;
}

}  // namespace kinfer
