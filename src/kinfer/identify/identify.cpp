#include "kinfer/identify/identify.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/identify/conclusion.hpp"
#include "kinfer/identify/forecast.hpp"
#include "kinfer/identify/found_chain.hpp"
#include "kinfer/identify/joint_type.hpp"
#include "kinfer/identify/loops.hpp"
#include "kinfer/identify/machines.hpp"
#include "kinfer/identify/motion_evidence.hpp"
#include "kinfer/identify/one_clock.hpp"
#include "kinfer/identify/ordered_motion.hpp"
#include "kinfer/identify/refined_identification.hpp"
#include "kinfer/identify/remount.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/measurement/chosen_sensors.hpp"

namespace kinfer {
namespace {

constexpr double safe_margin = 2.0;        // of the spanning tree
constexpr std::size_t judged_rows = 2000;  // rows that were not fitted, to judge on
constexpr std::size_t posed_rows = 100;    // poses from which an axis is read

/// What grows while the tree is walked from the root.
struct Progressing {
  const RecordedMotion& motion;
  const SegmentTree& tree;
  IdentifyOptions options;
  std::vector<std::vector<FrameState>> states;  // of the found chain, by segment; empty where not found yet
  Identification result;
};

/// The angle of the hinge that the found states are nearest to, with rates of these states.
JointSignal hinge_angle(const HingeGeometry& hinge, const std::vector<FrameState>& parent,
                        const std::vector<FrameState>& child) {
  JointSignal signal{.name = "angle", .angle = {}, .rate = {}, .rate_change = {}};
  const Quat home(hinge.home.rotation);
  for (std::size_t row = 0; row < parent.size(); ++row) {
    const Mat3 to_parent = parent[row].rotation.transpose();
    const Quat turn = Quat(Mat3(to_parent * child[row].rotation)) * home.conjugate();
    const Vec3 rate = child[row].rate - parent[row].rate;
    const Vec3 rate_change = child[row].rate_change - parent[row].rate_change - parent[row].rate.cross(rate);
    signal.angle.push_back(2.0 * std::atan2(hinge.axis_in_parent.dot(turn.vec()), turn.w()));
    signal.rate.push_back(hinge.axis_in_parent.dot(to_parent * rate));
    signal.rate_change.push_back(hinge.axis_in_parent.dot(to_parent * rate_change));
  }
  return signal;
}

FoundFit fit_of(const JRmse& j) {
  return {j.total, j.acceleration, j.orientation};
}

std::vector<std::size_t> without(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& taken) {
  std::vector<std::size_t> rest;
  std::ranges::set_difference(rows, taken, std::back_inserter(rest));
  return rest;
}

/// What every engine finds for one link.
struct SearchedLink {
  std::vector<DhLeaf> leaves;
  std::int64_t evaluations = 0;
  int generations = 0;
  std::vector<double> best, median;
};

SearchedLink searched_link(const IdentifyOptions& options, const std::vector<FrameState>& parent,
                           const std::vector<FrameState>& measured, const std::vector<JointSignal>& signals,
                           const std::vector<std::size_t>& rows, const Rng& rng, const Observer& observer) {
  if (options.engine == Engine::bp) {
    DhEvolution found = search_link(parent, measured, signals, rows, options.search, rng, observer);
    return {leaves(found.best), found.evaluations, found.generations, std::move(found.best_history),
            std::move(found.median_history)};
  }
  MemeticOutcome found = options.engine == Engine::bmp
                             ? search_memetic(parent, measured, signals, rows, options.memetic, rng, observer)
                             : search_all(parent, measured, signals, rows, options.memetic);
  return {std::move(found.leaves), found.evaluations, found.generations, std::move(found.best_history),
          std::move(found.median_history)};
}

/// Paper 1's step for one segment: find its sub-tree behind the frozen chain, then freeze it. The memetic engines go
/// out from what the parent's INS measured, so that no link inherits another's errors.
void add_hinge(Progressing& p, std::size_t parent, std::size_t child, const std::vector<JointSignal>& signals,
               const std::vector<std::size_t>& rows, const Rng& rng, const Observer& observer) {
  const std::string &parent_name = p.motion.segments[parent].name, &name = p.motion.segments[child].name;
  const std::vector<FrameState> measured = measured_states(p.motion.segments[child]);
  const LinkSearchOptions& options = p.options.search;
  const std::vector<FrameState> before =
      p.options.engine == Engine::bp ? p.states[parent] : measured_states(p.motion.segments[parent]);
  SearchedLink evolution = searched_link(p.options, before, measured, signals, rows, rng, observer);
  const std::vector<DhLeaf>& found = evolution.leaves;
  p.states[child] = carried(before, found, signals);

  const auto fitted = evenly_chosen(rows, static_cast<std::size_t>(options.rows));
  std::vector<SignalRow> poses;
  for (const std::size_t row : evenly_chosen(rows, posed_rows)) poses.push_back(signals_at(signals, row));
  FoundHinge hinge{hinge_geometry(found, poses), {}};
  hinge.precision =
      hinge_precision(hinge.geometry, before, measured, hinge_angle(hinge.geometry, before, p.states[child]), fitted);
  const FoundJoint joint = found_joint(parent_name, name, hinge);
  if (signal_uses(found) > 1)
    p.result.notes.push_back(
        fmt::format("the chain to {} uses {} signals, so it is no hinge; its axis is the one nearest to it", name,
                    signal_uses(found)));
  std::ranges::copy(canonical_rows(joint, hinge), std::back_inserter(p.result.dh));
  p.result.joints.push_back(joint);
  const auto judged = evenly_chosen(without(rows, fitted), judged_rows);
  p.result.searches.push_back({.segment = name,
                               .fitted = fit_of(j_rmse(p.states[child], measured, fitted, options.cost.orientation)),
                               .holdout = fit_of(j_rmse(p.states[child], measured, judged, options.cost.orientation)),
                               .rows = static_cast<int>(fitted.size()),
                               .found = found_rows(name, found, signals),
                               .merged = found_rows(name, merged(found), signals),
                               .evaluations = evolution.evaluations,
                               .generations = evolution.generations,
                               .best = std::move(evolution.best),
                               .median = std::move(evolution.median)});
}

constexpr JointDeviation not_estimated{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, 1.0};  // [rad], [m]

/// What all joints without search share: they are told by the pair of their sensors alone.
void add_unsearched(Progressing& p, const FoundJoint& joint, const HingeGeometry& geometry, std::size_t child) {
  p.result.joints.push_back(joint);
  std::ranges::copy(canonical_rows(joint, {geometry, {}}), std::back_inserter(p.result.dh));
  p.states[child] = measured_states(p.motion.segments[child]);
}

/// Bacterial programming knows no sliding joints (paper 1, section VI).
void add_slide(Progressing& p, std::size_t parent, std::size_t child, const JointTypeEvidence& evidence) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  HingeGeometry slide;
  slide.axis_in_parent = evidence.axis_in_parent;
  slide.axis_in_child = evidence.axis_in_child;
  const std::size_t home = p.motion.first_motion;
  slide.home.rotation = a.rotation[home].transpose() * b.rotation[home];
  FoundJoint joint{.parent = a.name, .child = b.name, .type = FoundJointType::prismatic};
  joint.axis_in_parent = slide.axis_in_parent;
  joint.axis_in_child = slide.axis_in_child;
  joint.sd = not_estimated;
  joint.not_identifiable.push_back("the place of the slide: it has no line of its own, only a direction");
  p.result.notes.push_back(fmt::format("{} slides on {}", b.name, a.name));
  add_unsearched(p, joint, slide, child);
}

/// Two or three axes through one point: the pair's common point is its centre.
void add_centred(Progressing& p, std::size_t parent, std::size_t child, const JointTypeEvidence& evidence) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  const PairFit& pair = p.tree.pair(parent, child);
  HingeGeometry geometry;
  geometry.axis_in_parent = evidence.axis_in_parent;
  geometry.axis_in_child = evidence.axis_in_child;
  geometry.point_in_parent = pair.first == parent ? pair.point_in_first : pair.point_in_second;
  geometry.point_in_child = pair.first == parent ? pair.point_in_second : pair.point_in_first;
  const std::size_t home = p.motion.first_motion;
  geometry.home.rotation = a.rotation[home].transpose() * b.rotation[home];
  geometry.home.position = geometry.point_in_parent - geometry.home.rotation * geometry.point_in_child;
  FoundJoint joint{.parent = a.name, .child = b.name, .type = evidence.type};
  joint.axis_in_parent = geometry.axis_in_parent;
  joint.axis_in_child = geometry.axis_in_child;
  joint.point_in_parent = geometry.point_in_parent;
  joint.point_in_child = geometry.point_in_child;
  joint.sd = not_estimated;
  p.result.notes.push_back(evidence.type == FoundJointType::universal
                               ? fmt::format("{} turns on {} about two axes, one fixed in each", b.name, a.name)
                               : fmt::format("{} turns on {} about every axis through one point", b.name, a.name));
  add_unsearched(p, joint, geometry, child);
}

/// The lever from the parent's sensor to the child's that their accelerations ask for, the shortest one.
Vec3 rigid_lever(const RecordedMotion& motion, const SegmentMotion& a, const SegmentMotion& b) {
  constexpr double shortness = 1e-4;  // [1/s⁴] a row: prior on what no acceleration tells
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (std::size_t row = motion.first_motion; row < motion.rows(); ++row) {
    if (!motion.usable[row]) continue;
    const Mat3 rate = skew(a.rate[row]);
    const Mat3 effect = (skew(a.rate_change[row]) + rate * rate) * a.rotation[row];
    normal += effect.transpose() * effect + shortness * Mat3::Identity();
    right += effect.transpose() * (b.acceleration[row] - a.acceleration[row]);
  }
  return solve_least_squares(normal, right);
}

/// Two sensors that never move against each other: on one segment, or beside a joint that nobody moved.
void add_rigid(Progressing& p, std::size_t parent, std::size_t child) {
  const SegmentMotion &a = p.motion.segments[parent], &b = p.motion.segments[child];
  std::vector<Mat3> relative;
  for (std::size_t row = 0; row < p.motion.rows(); ++row)
    relative.push_back(a.rotation[row].transpose() * b.rotation[row]);
  HingeGeometry mount;
  mount.home = {mean_rotation(relative), rigid_lever(p.motion, a, b)};
  mount.axis_in_child = Vec3::UnitZ();
  mount.axis_in_parent = mount.home.rotation.col(2);
  mount.point_in_parent = mount.home.position;
  FoundJoint joint{.parent = a.name, .child = b.name, .type = FoundJointType::rigid};
  joint.axis_in_parent = mount.axis_in_parent;
  joint.point_in_parent = mount.point_in_parent;
  joint.not_identifiable.push_back("the axis of a joint, if there is one");
  p.result.notes.push_back(fmt::format(
      "{} never moves against {}: on the same segment, or the joint between them is not excited", b.name, a.name));
  add_unsearched(p, joint, mount, child);
}

Result<void> add_joint(Progressing& p, std::size_t child, const JointTypeEvidence& evidence, const Rng& rng,
                       const Observer& observer) {
  const std::size_t parent = *p.tree.parent[child];
  const std::string& name = p.motion.segments[child].name;
  const auto signals = joint_signals(p.motion, parent, child,
                                     {.terminals = p.options.terminals, .smoothing = p.options.motion.smoothing});
  if (evidence.type == FoundJointType::prismatic) return add_slide(p, parent, child, evidence), Result<void>{};
  if (evidence.type == FoundJointType::rigid || signals.empty()) return add_rigid(p, parent, child), Result<void>{};
  if (evidence.type != FoundJointType::revolute) return add_centred(p, parent, child, evidence), Result<void>{};
  const auto rows = telling_rows(p.motion, parent, child, p.options.terminals);
  if (rows.size() < 64) return error("only {} rows tell about {}: it hardly moves", rows.size(), name);
  add_hinge(p, parent, child, signals, rows, rng, [&](Progress progress) {
    progress.detail = name;
    return tell(observer, progress);
  });
  return {};
}

OrderEvidence order_evidence(const RecordedMotion& motion, const SegmentTree& tree, const MovingPhases& phases) {
  OrderEvidence order{.sensors = {},
                      .pairs = {},
                      .margin = tree.margin,
                      .phases = {},
                      .rank = phases.rank,
                      .phases_agree = agree(phases, tree)};
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

/// The paper's search as the paper has it. With our own terminals: signals whose zero is arbitrary may have an offset,
/// and orientations are compared without gimbal lock.
void follow_terminals(IdentifyOptions& options) {
  LinkSearchOptions& search = options.search;
  search.cost.orientation = OrientationError::euler;
  search.leaf.signal_angles = SignalAngles::plain;
  if (options.terminals == Terminals::euler) {
    options.engine = Engine::bp;  // three terminals a link: what the paper's search is for
    return;
  }
  search.cost.orientation = OrientationError::chord;
  search.leaf.signal_angles = SignalAngles::offset;
}

std::string name_of(Engine engine) {
  return engine == Engine::bmp ? "bmp" : engine == Engine::bp ? "bp" : "enum";
}

/// Part of a recording that identification should rather go on with.
struct Part {
  std::vector<std::size_t> sensors;
  double begin = 0.0, end = 0.0;  ///< [s]
  std::vector<Finding> findings;
};

/// An identification, and what its fit found out about the clocks; or the part of the recording to begin again with.
struct Found {
  Identification result{};
  std::vector<RefinedClock> clocks{};
  std::optional<Part> rather{};
  std::vector<Finding> on_the_ground{};  ///< groups that share nothing but a root that stands still
};

/// The sensors that were asked for, or all, without those that never move.
Result<Chosen> chosen_sensors(const InsRecording& recording, const IdentifyOptions& options) {
  std::vector<std::size_t> asked;
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) asked.push_back(s);
  if (!options.sensors.empty()) {
    KINFER_TRY(named, sensors_named(recording, options.sensors));
    asked = named;
  }
  Chosen chosen = options.sensors.empty() ? without_idle(recording, options.motion, options.root)
                                          : without_idle(with_sensors(recording, asked), options.motion, options.root);
  for (std::size_t& s : chosen.sensors) s = asked[s];
  return chosen;
}

/// What is wrong with the recording as a whole, and the part of it that is sound.
std::optional<Part> sound_part(const OrderedMotion& ordered, const IdentifyOptions& options) {
  const RecordedMotion& motion = ordered.motion;
  Part all{.sensors = {}, .begin = motion.time.front() - 1.0, .end = motion.time.back() + 1.0, .findings = {}};
  for (std::size_t s = 0; s < motion.segments.size(); ++s) all.sensors.push_back(s);
  if (const auto remount = find_remount(ordered, options.threads)) {
    if (remount->before_tells_more)
      all.end = remount->begin;
    else
      all.begin = remount->end;
    all.findings.push_back(finding_about(*remount, motion));
    return all;
  }
  if (!options.tree.empty()) return std::nullopt;
  Chosen chosen = one_machine(ordered, options.root);
  if (chosen.sensors.size() == motion.segments.size()) return std::nullopt;
  all.sensors = std::move(chosen.sensors);
  all.findings = std::move(chosen.findings);
  return all;
}

void say_order(Identification& result, const OrderedMotion& ordered, const IdentifyOptions& options) {
  const auto closing = options.tree.empty() ? loop_closing_pairs(ordered.tree) : std::vector<PairFit>{};
  result.order = order_evidence(ordered.motion, ordered.tree, moving_phases(ordered.motion));
  result.order.margin = margin_of(ordered.tree, closing);
  note_order(result);
  result.findings = loop_findings(ordered.tree, closing, segment_names(ordered.motion));
  std::ranges::copy(ordered.findings, std::back_inserter(result.findings));
}

/// All sensors on one clock, as far as is known.
Result<Found> identify_synchronous(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                                   const Observer& observer) {
  KINFER_TRY(ordered, ordered_motion(recording, options.motion, options.root, options.threads, options.tree));
  if (auto part = sound_part(ordered, options)) return Found{.rather = std::move(part)};
  const RecordedMotion& motion = ordered.motion;
  const SegmentTree& tree = ordered.tree;
  Progressing p{motion, tree, options, std::vector<std::vector<FrameState>>(motion.segments.size()), {}};
  p.result.root = motion.segments[tree.root].name;
  p.result.engine = name_of(options.engine);
  say_order(p.result, ordered, options);
  p.states[tree.root] = measured_states(motion.segments[tree.root]);
  const std::size_t links = options.links > 0 ? static_cast<std::size_t>(options.links) : tree.order.size();
  const auto types = joint_types(motion, tree);
  for (std::size_t i = 1; i < tree.order.size() && i <= links; ++i)
    if (auto done = add_joint(p, tree.order[i], types[i - 1], rng.stream(i), observer); !done)
      return pass_on(done.error());
  if (std::ranges::all_of(p.result.joints, [](const FoundJoint& j) { return j.type == FoundJointType::rigid; }))
    return error("no sensor ever moves against another: move every joint of the machine");
  p.states = {};
  RefinedGeometry geometry;
  if (options.geometry == Geometry::refined) {
    KINFER_TRY(refined, refine_geometry(p.result, recording, motion, tree, options.refine, observer));
    geometry = std::move(refined);
  }
  p.result.links = found_links(p.result.joints);
  p.result.chain =
      found_chain(p.result.root, p.result.joints, p.result.dh, motion.segments[tree.root].rotation.front());
  carry_tool(p.result.chain, p.result.places);
  p.result.motion = motion_evidence(motion, p.result, geometry.held_out);
  return Found{.result = std::move(p.result),
               .clocks = std::move(geometry.clocks),
               .rather = {},
               .on_the_ground = groups_on_the_ground(ordered)};
}

}  // namespace

Result<Identification> identify(const InsRecording& recording, const IdentifyOptions& given, const Rng& rng,
                                const Observer& observer) {
  constexpr int most_passes = 3, most_parts = 6;
  IdentifyOptions options = given;
  options.search.bacteria.threads = options.memetic.bacteria.threads = options.refine.fit.threads = options.threads;
  follow_terminals(options);
  KINFER_TRY(chosen, chosen_sensors(recording, options));
  std::optional<InsRecording> part;  // only where not all of the recording is used: an hour's is large
  if (chosen.sensors.size() < recording.sensors.size()) part = with_sensors(recording, chosen.sensors);
  const InsRecording* base = part ? &*part : &recording;
  OneClock clock = on_one_clock(*base, options.motion, options.threads);
  Found found;
  for (int pass = 0, narrowed = 0; pass < most_passes;) {
    options.refine.clocks = clock.trust;
    KINFER_TRY(now, identify_synchronous(clock.of(*base), options, rng, observer));
    found = std::move(now);
    if (found.rather) {
      if (++narrowed > most_parts) return error("the recording is wrong in more ways than can be told");
      narrow(clock, *base, found.rather->sensors, found.rather->begin, found.rather->end);
      part = with_sensors(*base, found.rather->sensors);
      base = &*part;
      std::ranges::move(found.rather->findings, std::back_inserter(chosen.findings));
    } else if (!take_up(clock, *base, found.clocks)) {
      break;
    } else {
      ++pass;
    }
  }
  Identification& result = found.result;
  if (std::ranges::find(chosen.findings, "idle", &Finding::kind) != chosen.findings.end())
    std::ranges::move(found.on_the_ground, std::back_inserter(chosen.findings));
  result.findings.insert(result.findings.begin(), chosen.findings.begin(), chosen.findings.end());
  say_clocks(result, clock, *base, found.clocks);
  result.forecast = forecast(result.joints);
  conclude(result);
  result.next = identification_advice(result);
  return result;
}

}  // namespace kinfer
