// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/pipeline.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/identify/findings/forecast.hpp"
#include "kinfer/identify/findings/motion_evidence.hpp"
#include "kinfer/identify/findings/verdict.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/identify/refinement/refine_geometry.hpp"
#include "kinfer/identify/screening/loops.hpp"
#include "kinfer/identify/screening/remount.hpp"
#include "kinfer/identify/screening/sensor_selection.hpp"
#include "kinfer/identify/screening/synchronisation.hpp"
#include "kinfer/identify/structure/joint_type.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/measurement/ins_selection.hpp"

namespace kinfer::identify {
namespace {

constexpr double safe_margin = 2.0;            // of the spanning tree
constexpr std::size_t evaluation_rows = 2000;  // held-out rows for evaluation
constexpr std::size_t pose_rows = 100;         // poses from which an axis is computed

/// State of the traversal of the tree from the root.
struct IdentificationState {
  const RecordedMotion& motion;
  const SegmentTree& tree;
  IdentifyOptions options;
  std::vector<std::vector<FrameState>> states;  // of the chain so far, by segment; empty if not reached yet
  Identification result;
};

/// The revolute joint's angle nearest to these states, with its first two time derivatives.
JointSignal revolute_angle(const JointGeometry& hinge, const std::vector<FrameState>& parent,
                           const std::vector<FrameState>& child) {
  JointSignal signal{.name = "angle", .angle = {}, .angular_velocity = {}, .angular_acceleration = {}};
  const Quat home(hinge.home.rotation);
  for (std::size_t row = 0; row < parent.size(); ++row) {
    const Mat3 to_parent = parent[row].rotation.transpose();
    const Quat turn = Quat(Mat3(to_parent * child[row].rotation)) * home.conjugate();
    const Vec3 angular_velocity = child[row].angular_velocity - parent[row].angular_velocity;
    const Vec3 angular_acceleration = child[row].angular_acceleration - parent[row].angular_acceleration -
                                      parent[row].angular_velocity.cross(angular_velocity);
    signal.angle.push_back(2.0 * std::atan2(hinge.axis_in_parent.dot(turn.vec()), turn.w()));
    signal.angular_velocity.push_back(hinge.axis_in_parent.dot(to_parent * angular_velocity));
    signal.angular_acceleration.push_back(hinge.axis_in_parent.dot(to_parent * angular_acceleration));
  }
  return signal;
}

LinkFit link_fit(const JRmse& j) {
  return {j.total, j.acceleration, j.orientation};
}

std::vector<std::size_t> rows_except(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& excluded) {
  std::vector<std::size_t> remaining;
  std::ranges::set_difference(rows, excluded, std::back_inserter(remaining));
  return remaining;
}

/// Result of any engine for one link.
struct SearchedLink {
  std::vector<DhLeaf> leaves;
  std::int64_t evaluations = 0;
  int generations = 0;
  std::vector<double> best, median;
};

SearchedLink search_link_with(const IdentifyOptions& options, const std::vector<FrameState>& parent,
                              const std::vector<FrameState>& measured, const std::vector<JointSignal>& signals,
                              const std::vector<std::size_t>& rows, const Rng& rng, const Observer& observer) {
  if (options.engine == Engine::bp) {
    LinkEvolution found = search_bacterial(parent, measured, signals, rows, options.search, rng, observer);
    return {leaves(found.best), found.evaluations, found.generations, std::move(found.best_history),
            std::move(found.median_history)};
  }
  StructureSearchOutcome found = options.engine == Engine::bmp
                                     ? search_memetic(parent, measured, signals, rows, options.memetic, rng, observer)
                                     : search_exhaustive(parent, measured, signals, rows, options.memetic);
  return {std::move(found.leaves), found.evaluations, found.generations, std::move(found.best_history),
          std::move(found.median_history)};
}

/// Paper 1's step for one segment: search its sub-tree behind the fixed chain, then fix it. The memetic engines start
/// from the measurements of the parent's INS, so that errors do not accumulate along the chain.
void add_revolute(IdentificationState& p, std::size_t parent, std::size_t child,
                  const std::vector<JointSignal>& signals, const std::vector<std::size_t>& rows, const Rng& rng,
                  const Observer& observer) {
  const std::string &parent_name = p.motion.segments[parent].name, &name = p.motion.segments[child].name;
  const std::vector<FrameState> measured = measured_states(p.motion.segments[child]);
  const BacterialLinkOptions& options = p.options.search;
  const std::vector<FrameState> parent_states =
      p.options.engine == Engine::bp ? p.states[parent] : measured_states(p.motion.segments[parent]);
  SearchedLink evolution = search_link_with(p.options, parent_states, measured, signals, rows, rng, observer);
  const std::vector<DhLeaf>& found = evolution.leaves;
  p.states[child] = propagate(parent_states, found, signals);

  const auto fitted = thin_rows(rows, static_cast<std::size_t>(options.rows));
  std::vector<SignalRow> poses;
  for (const std::size_t row : thin_rows(rows, pose_rows)) poses.push_back(signals_at(signals, row));
  GeometryEstimate hinge{fit_revolute_geometry(found, poses), {}};
  hinge.precision = revolute_precision(hinge.geometry, parent_states, measured,
                                       revolute_angle(hinge.geometry, parent_states, p.states[child]), fitted);
  const JointEstimate joint = joint_estimate(parent_name, name, hinge);
  if (count_signal_uses(found) > 1)
    p.result.notes.push_back(
        fmt::format("the chain to {} uses {} signals, so it is no hinge; its axis is the one nearest to it", name,
                    count_signal_uses(found)));
  std::ranges::copy(canonical_dh_rows(joint, hinge), std::back_inserter(p.result.dh));
  p.result.joints.push_back(joint);
  const auto unfitted_rows = thin_rows(rows_except(rows, fitted), evaluation_rows);
  p.result.searches.push_back(
      {.segment = name,
       .fitted = link_fit(j_rmse(p.states[child], measured, fitted, options.cost.orientation)),
       .holdout = link_fit(j_rmse(p.states[child], measured, unfitted_rows, options.cost.orientation)),
       .rows = static_cast<int>(fitted.size()),
       .found = leaf_dh_rows(name, found, signals),
       .merged = leaf_dh_rows(name, merge_leaves(found), signals),
       .evaluations = evolution.evaluations,
       .generations = evolution.generations,
       .best = std::move(evolution.best),
       .median = std::move(evolution.median)});
}

constexpr JointStandardDeviation not_estimated{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, 1.0};  // [rad], [m]

/// Common part of all joints without a search: they are estimated from their pair of sensors alone.
void add_without_search(IdentificationState& p, const JointEstimate& joint, const JointGeometry& geometry,
                        std::size_t child) {
  p.result.joints.push_back(joint);
  std::ranges::copy(canonical_dh_rows(joint, {geometry, {}}), std::back_inserter(p.result.dh));
  p.states[child] = measured_states(p.motion.segments[child]);
}

/// Bacterial programming has no prismatic joints (paper 1, section VI).
void add_prismatic(IdentificationState& p, std::size_t parent, std::size_t child, const JointTypeEvidence& evidence) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  JointGeometry joint_geometry;
  joint_geometry.axis_in_parent = evidence.axis_in_parent;
  joint_geometry.axis_in_child = evidence.axis_in_child;
  const std::size_t home = p.motion.first_motion_row;
  joint_geometry.home.rotation = a.rotation[home].transpose() * b.rotation[home];
  JointEstimate joint{.parent = a.name, .child = b.name, .type = EstimatedJointType::prismatic};
  joint.axis_in_parent = joint_geometry.axis_in_parent;
  joint.axis_in_child = joint_geometry.axis_in_child;
  joint.sd = not_estimated;
  joint.unobservable.push_back("the place of the slide: it has no line of its own, only a direction");
  p.result.notes.push_back(fmt::format("{} slides on {}", b.name, a.name));
  add_without_search(p, joint, joint_geometry, child);
}

/// Universal or spherical: the pair's common point is the joint's centre.
void add_spherical_or_universal(IdentificationState& p, std::size_t parent, std::size_t child,
                                const JointTypeEvidence& evidence) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  const PairFit& pair = p.tree.pair(parent, child);
  JointGeometry geometry;
  geometry.axis_in_parent = evidence.axis_in_parent;
  geometry.axis_in_child = evidence.axis_in_child;
  geometry.point_in_parent = pair.first == parent ? pair.point_in_first : pair.point_in_second;
  geometry.point_in_child = pair.first == parent ? pair.point_in_second : pair.point_in_first;
  const std::size_t home = p.motion.first_motion_row;
  geometry.home.rotation = a.rotation[home].transpose() * b.rotation[home];
  geometry.home.position = geometry.point_in_parent - geometry.home.rotation * geometry.point_in_child;
  JointEstimate joint{.parent = a.name, .child = b.name, .type = evidence.type};
  joint.axis_in_parent = geometry.axis_in_parent;
  joint.axis_in_child = geometry.axis_in_child;
  joint.point_in_parent = geometry.point_in_parent;
  joint.point_in_child = geometry.point_in_child;
  joint.sd = not_estimated;
  p.result.notes.push_back(evidence.type == EstimatedJointType::universal
                               ? fmt::format("{} turns on {} about two axes, one fixed in each", b.name, a.name)
                               : fmt::format("{} turns on {} about every axis through one point", b.name, a.name));
  add_without_search(p, joint, geometry, child);
}

/// Minimum-norm lever arm from the parent's sensor to the child's that explains their accelerations.
Vec3 fit_rigid_lever(const RecordedMotion& motion, const SegmentMotion& a, const SegmentMotion& b) {
  constexpr double prior_weight = 1e-4;  // [1/s⁴] per row: prior on the unobservable directions
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Mat3 angular_velocity = skew(a.angular_velocity[row]);
    const Mat3 effect = (skew(a.angular_acceleration[row]) + angular_velocity * angular_velocity) * a.rotation[row];
    normal += effect.transpose() * effect + prior_weight * Mat3::Identity();
    right += effect.transpose() * (b.acceleration[row] - a.acceleration[row]);
  }
  return solve_least_squares(normal, right);
}

/// Two sensors without relative motion: on the same segment, or on both sides of a joint that was not moved.
void add_rigid(IdentificationState& p, std::size_t parent, std::size_t child) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  std::vector<Mat3> relative;
  for (std::size_t row = 0; row < p.motion.rows(); ++row)
    relative.push_back(a.rotation[row].transpose() * b.rotation[row]);
  JointGeometry mount;
  mount.home = {mean_rotation(relative), fit_rigid_lever(p.motion, a, b)};
  mount.axis_in_child = Vec3::UnitZ();
  mount.axis_in_parent = mount.home.rotation.col(2);
  mount.point_in_parent = mount.home.position;
  JointEstimate joint{.parent = a.name, .child = b.name, .type = EstimatedJointType::rigid};
  joint.axis_in_parent = mount.axis_in_parent;
  joint.point_in_parent = mount.point_in_parent;
  joint.unobservable.push_back("the axis of a joint, if there is one");
  p.result.notes.push_back(fmt::format(
      "{} never moves against {}: on the same segment, or the joint between them is not excited", b.name, a.name));
  add_without_search(p, joint, mount, child);
}

Result<void> add_joint(IdentificationState& p, std::size_t child, const JointTypeEvidence& evidence, const Rng& rng,
                       const Observer& observer) {
  const std::size_t parent = *p.tree.parent[child];
  const std::string& name = p.motion.segments[child].name;
  const auto signals = find_joint_signals(p.motion, parent, child,
                                          {.terminals = p.options.terminals, .smoothing = p.options.motion.smoothing});
  if (evidence.type == EstimatedJointType::prismatic) return add_prismatic(p, parent, child, evidence), Result<void>{};
  if (evidence.type == EstimatedJointType::rigid || signals.empty()) return add_rigid(p, parent, child), Result<void>{};
  if (evidence.type != EstimatedJointType::revolute)
    return add_spherical_or_universal(p, parent, child, evidence), Result<void>{};
  const auto rows = informative_rows(p.motion, parent, child, p.options.terminals);
  if (rows.size() < 64) return error("only {} informative rows about {}: it hardly moves", rows.size(), name);
  add_revolute(p, parent, child, signals, rows, rng, [&](Progress progress) {
    progress.detail = name;
    return notify(observer, progress);
  });
  return {};
}

OrderEvidence order_evidence(const RecordedMotion& motion, const SegmentTree& tree, const MovingPhases& phases) {
  OrderEvidence order{.sensors = {},
                      .pairs = {},
                      .margin = tree.margin,
                      .phases = {},
                      .rank = phases.rank,
                      .phases_agree = has_same_parents(phases, tree)};
  for (const SegmentMotion& segment : motion.segments) order.sensors.push_back(segment.name);
  for (const PairFit& pair : tree.pairs)
    order.pairs.push_back({order.sensors[pair.first], order.sensors[pair.second], pair.residual(), pair.off_axis_rate(),
                           pair.distance,
                           tree.parent[pair.first] == pair.second || tree.parent[pair.second] == pair.first});
  for (const MovingPhase& phase : phases.phases) order.phases.push_back({phase.begin, phase.end, phase.moves});
  return order;
}

void note_order(Identification& result) {
  if (result.order.margin < safe_margin)
    result.notes.push_back(fmt::format(
        "the order of the segments is not safe: another tree fits almost as well (margin {:.2f}, safe is {})",
        result.order.margin, safe_margin));
  if (!result.order.phases_agree)
    result.notes.push_back(
        "who moves when does not give the same order: joints that move together, a moving base or a swaying machine; "
        "the "
        "pairwise fits are believed");
}

/// Euler terminals: paper 1's search unchanged. Hinge terminals: signals have an arbitrary zero, so an offset is
/// allowed, and orientations are compared by a measure without gimbal lock.
void apply_terminals(IdentifyOptions& options) {
  BacterialLinkOptions& search = options.search;
  search.cost.orientation = OrientationMetric::euler;
  search.leaf.signal_angle_form = SignalAngleForm::plain;
  if (options.terminals == JointVariableKind::euler) {
    options.engine = Engine::bp;  // three terminals per link: the case of paper 1's search
    return;
  }
  search.cost.orientation = OrientationMetric::chord;
  search.leaf.signal_angle_form = SignalAngleForm::offset;
}

std::string engine_name(Engine engine) {
  return engine == Engine::bmp ? "bmp" : engine == Engine::bp ? "bp" : "enum";
}

/// Sensors and time span of a recording that are consistent, and the findings about the rest.
struct RecordingSelection {
  std::vector<std::size_t> sensors;
  double begin = 0.0, end = 0.0;  ///< [s]
  std::vector<Finding> findings;
};

/// Result of one pass: an identification and the clocks of its fit, or the part of the recording to restart with.
struct PassResult {
  Identification result{};
  std::vector<ResidualClock> clocks{};
  std::optional<RecordingSelection> restart_with{};
  std::vector<Finding> attached_to_world{};  ///< groups that share only a stationary root
};

/// The sensors selected in the options, or all, without those that never move.
Result<SensorSelection> select_moving_sensors(const InsRecording& recording, const IdentifyOptions& options) {
  std::vector<std::size_t> requested;
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) requested.push_back(s);
  if (!options.sensors.empty()) {
    KINFER_TRY(named, find_sensors(recording, options.sensors));
    requested = named;
  }
  SensorSelection chosen = options.sensors.empty() ? exclude_idle_sensors(recording, options.motion, options.root)
                                                   : exclude_idle_sensors(select_sensors(recording, requested),
                                                                          options.motion, options.root);
  for (std::size_t& s : chosen.sensors) s = requested[s];
  return chosen;
}

/// The consistent part of a recording with a remounted sensor or several machines; none if all of it is consistent.
std::optional<RecordingSelection> select_consistent_part(const OrderedMotion& ordered, const IdentifyOptions& options) {
  const RecordedMotion& motion = ordered.motion;
  RecordingSelection all{
      .sensors = {}, .begin = motion.time.front() - 1.0, .end = motion.time.back() + 1.0, .findings = {}};
  for (std::size_t s = 0; s < motion.segments.size(); ++s) all.sensors.push_back(s);
  if (const auto remount = find_remount(ordered, options.threads)) {
    if (remount->before_is_more_informative)
      all.end = remount->begin;
    else
      all.begin = remount->end;
    all.findings.push_back(finding_about(*remount, motion));
    return all;
  }
  if (!options.tree.empty()) return std::nullopt;
  SensorSelection chosen = select_machine(ordered, options.root);
  if (chosen.sensors.size() == motion.segments.size()) return std::nullopt;
  all.sensors = std::move(chosen.sensors);
  all.findings = std::move(chosen.findings);
  return all;
}

void report_order(Identification& result, const OrderedMotion& ordered, const IdentifyOptions& options) {
  const auto closing_pairs = options.tree.empty() ? loop_closing_pairs(ordered.tree) : std::vector<PairFit>{};
  result.order = order_evidence(ordered.motion, ordered.tree, moving_phases(ordered.motion));
  result.order.margin = margin_of(ordered.tree, closing_pairs);
  note_order(result);
  result.findings = loop_findings(ordered.tree, closing_pairs, segment_names(ordered.motion));
  std::ranges::copy(ordered.findings, std::back_inserter(result.findings));
}

/// One pass on a recording whose sensors share one clock, as far as known.
Result<PassResult> run_pass(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                            const Observer& observer) {
  KINFER_TRY(ordered, order_segments(recording, options.motion, options.root, options.threads, options.tree));
  if (auto part = select_consistent_part(ordered, options)) return PassResult{.restart_with = std::move(part)};
  const RecordedMotion& motion = ordered.motion;
  const SegmentTree& tree = ordered.tree;
  IdentificationState p{motion, tree, options, std::vector<std::vector<FrameState>>(motion.segments.size()), {}};
  p.result.root = motion.segments[tree.root].name;
  p.result.engine = engine_name(options.engine);
  report_order(p.result, ordered, options);
  p.states[tree.root] = measured_states(motion.segments[tree.root]);
  const std::size_t links = options.links > 0 ? static_cast<std::size_t>(options.links) : tree.order.size();
  const auto types = joint_types(motion, tree);
  for (std::size_t i = 1; i < tree.order.size() && i <= links; ++i)
    if (auto done = add_joint(p, tree.order[i], types[i - 1], rng.stream(i), observer); !done)
      return forward_error(done.error());
  if (std::ranges::all_of(p.result.joints, [](const JointEstimate& j) { return j.type == EstimatedJointType::rigid; }))
    return error("no sensor moves relative to another: move every joint of the machine");
  p.states = {};
  RefinementExtras geometry;
  if (options.geometry == GeometrySource::refined) {
    KINFER_TRY(refined, refine_geometry(p.result, recording, motion, tree, options.refine, observer));
    geometry = std::move(refined);
  }
  p.result.links = link_estimates(p.result.joints);
  p.result.chain =
      build_chain(p.result.root, p.result.joints, p.result.dh, motion.segments[tree.root].rotation.front());
  set_tool(p.result.chain, p.result.places);
  p.result.motion = motion_evidence(motion, p.result, geometry.held_out);
  return PassResult{.result = std::move(p.result),
                    .clocks = std::move(geometry.clocks),
                    .restart_with = {},
                    .attached_to_world = groups_attached_to_world(ordered)};
}

}  // namespace

Result<Identification> identify_machine(const InsRecording& recording, const IdentifyOptions& given, const Rng& rng,
                                        const Observer& observer) {
  constexpr int max_passes = 3, max_restarts = 6;
  IdentifyOptions options = given;
  options.search.bacteria.threads = options.memetic.bacteria.threads = options.refine.fit.threads = options.threads;
  apply_terminals(options);
  KINFER_TRY(chosen, select_moving_sensors(recording, options));
  std::optional<InsRecording> part;  // a copy only if a part is used: an hour's recording is large
  if (chosen.sensors.size() < recording.sensors.size()) part = select_sensors(recording, chosen.sensors);
  const InsRecording* base = part ? &*part : &recording;
  Synchronisation clock = synchronise_sensors(*base, options.motion, options.threads);
  PassResult found;
  for (int pass = 0, restarts = 0; pass < max_passes;) {
    options.refine.clocks = clock.clock_treatment;
    KINFER_TRY(now, run_pass(clock.of(*base), options, rng, observer));
    found = std::move(now);
    if (found.restart_with) {
      if (++restarts > max_restarts) return error("the recording has more faults than can be separated");
      restrict_to(clock, *base, found.restart_with->sensors, found.restart_with->begin, found.restart_with->end);
      part = select_sensors(*base, found.restart_with->sensors);
      base = &*part;
      std::ranges::move(found.restart_with->findings, std::back_inserter(chosen.findings));
    } else if (!update_clocks(clock, *base, found.clocks)) {
      break;
    } else {
      ++pass;
    }
  }
  Identification& result = found.result;
  if (std::ranges::find(chosen.findings, FindingKind::idle, &Finding::kind) != chosen.findings.end())
    std::ranges::move(found.attached_to_world, std::back_inserter(chosen.findings));
  result.findings.insert(result.findings.begin(), chosen.findings.begin(), chosen.findings.end());
  report_clocks(result, clock, *base, found.clocks);
  result.forecast = forecast(result.joints);
  set_verdict(result);
  result.next = identification_advice(result);
  return result;
}

}  // namespace kinfer::identify
