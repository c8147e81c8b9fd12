// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/pipeline.hpp"

#include <algorithm>

#include "kinfer/identify/diagnosis/diagnosis.hpp"
#include "kinfer/identify/findings/advice.hpp"
#include "kinfer/identify/findings/forecast.hpp"
#include "kinfer/identify/findings/given_links.hpp"
#include "kinfer/identify/findings/joint_verdicts.hpp"
#include "kinfer/identify/findings/motion_evidence.hpp"
#include "kinfer/identify/findings/order_evidence.hpp"
#include "kinfer/identify/findings/unobservable.hpp"
#include "kinfer/identify/findings/verdict.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"
#include "kinfer/identify/geometry/link_estimates.hpp"
#include "kinfer/identify/handover/complete_tracking.hpp"
#include "kinfer/identify/handover/told_biases.hpp"
#include "kinfer/identify/joints/search_links.hpp"
#include "kinfer/identify/joints/searched_joint.hpp"
#include "kinfer/identify/joints/thresholds.hpp"
#include "kinfer/identify/refinement/refine_geometry.hpp"
#include "kinfer/identify/screening/machines.hpp"
#include "kinfer/identify/screening/mixed_recording.hpp"
#include "kinfer/identify/screening/session.hpp"
#include "kinfer/identify/screening/unconnected.hpp"
#include "kinfer/identify/update/known_machine.hpp"
#include "kinfer/identify/update/updated_geometry.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"

namespace kinfer::identify {
namespace {

constexpr int max_bias_updates = 2;

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

const SegmentMotion& segment_of(const RecordedMotion& motion, const std::string& name) {
  return *std::ranges::find(motion.segments, name, &SegmentMotion::name);
}

std::optional<RecordingSelection> find_consistent_part(const OrderedMotion& ordered,
                                                       const std::vector<PairConnection>& connections,
                                                       const IdentifyOptions& options) {
  const auto separation = options.tree.empty() ? MachineSeparation::of_unconnected_groups : MachineSeparation::none;
  return select_consistent_part(ordered, connections, options.root, separation, options.threads);
}

LinkSearchOptions link_search_options(const IdentifyOptions& options) {
  return {.engine = options.engine,
          .smoothing = options.motion.smoothing,
          .links = options.links,
          .threads = options.threads};
}

ChainGeometry searched_geometry(const std::vector<JointResult>& links) {
  ChainGeometry geometry;
  for (const JointResult& link : links) {
    geometry.joints.push_back(link.joint);
    append(geometry.dh, link.dh);
    append(geometry.notes, link.notes);
  }
  return geometry;
}

/// Segments without a connection move relative to each other, however small that seems beside errors of their own; a
/// type of theirs means nothing.
std::vector<JointTypeEvidence> types_of(const OrderedMotion& ordered, const std::vector<PairConnection>& connections) {
  std::vector<JointTypeEvidence> types = joint_types(ordered.motion, ordered.tree);
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (strength_of(connections[i].whole) != ConnectionStrength::none) continue;
    if (types[i].type == EstimatedJointType::rigid) types[i].type = EstimatedJointType::spherical;
    types[i].probabilities.reset();
  }
  return types;
}

/// Evaluates the joints that are written in the terms of the search, on its rows.
void certify(std::vector<JointResult>& links, const std::vector<JointEstimate>& joints, const OrderedMotion& ordered,
             const IdentifyOptions& options) {
  const OrientationMetric metric = orientation_metric(options.engine);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].search) continue;
    const SegmentMotion &parent = segment_of(ordered.motion, joints[i].parent),
                        &child = segment_of(ordered.motion, joints[i].child);
    links[i].search->written_fitted = fit_of_joint(joints[i], parent, child, links[i].fitted_rows, metric);
    links[i].search->written_holdout = fit_of_joint(joints[i], parent, child, links[i].held_out_rows, metric);
  }
}

/// Whether a search predicts the held-out rows of its link notably better than the joint that the fit found.
bool contradicts_fit(const JointResult& link) {
  return link.search && link.search->written_holdout &&
         link.search->written_holdout->total > min_search_advantage * link.search->holdout.total;
}

/// The joints before the fit: searched, or as known from an earlier identification.
Result<std::vector<JointResult>> initial_joints(const OrderedMotion& ordered,
                                                const std::vector<PairConnection>& connections,
                                                const IdentifyOptions& options, const Rng& rng,
                                                const Observer& observer) {
  if (options.refine.known) return known_results(*options.refine.known);
  return search_links(ordered, types_of(ordered, connections), link_search_options(options), rng, observer);
}

/// The fit begins at the pairs of sensors. Where a search contradicts its result, the fit is made again from the joints
/// of the searches, and the better of both is kept. `links` get the certificate of what is kept. A fit of segments that
/// have nothing to do with each other takes minutes and means nothing; that of a single pair is short.
Result<ChainGeometry> final_geometry(std::vector<JointResult>& links, const Session& session,
                                     const OrderedMotion& ordered, const std::vector<PairConnection>& connections,
                                     const IdentifyOptions& options, const Observer& observer) {
  const ChainGeometry searched = searched_geometry(links);
  const bool is_hopeless = is_unconnected(connections) || is_one_body(searched.joints) ||
                           (connections.size() > 1 && !has_certain_joint(connections));
  if (options.geometry == GeometrySource::searched || is_hopeless) return searched;
  RefinementOptions refinement = options.refine;
  refinement.clocks = session.clock_treatment();
  refinement.fit.threads = options.threads;
  const auto refine_from = [&](StartSource start) {
    refinement.start = start;
    return refine_geometry(searched, session.recording(), ordered.motion, ordered.tree, refinement, observer);
  };
  KINFER_TRY(geometry, refine_from(options.refine.start));
  if (!geometry.negative_log_likelihood) return geometry;
  certify(links, geometry.joints, ordered, options);
  if (refinement.start != StartSource::pairs || std::ranges::none_of(links, contradicts_fit)) return geometry;
  auto other = refine_from(StartSource::search);
  if (!other || !other->negative_log_likelihood ||
      *other->negative_log_likelihood > *geometry.negative_log_likelihood - min_likelihood_gain)
    return geometry;
  other->starts_from_search = true;
  certify(links, other->joints, ordered, options);
  return std::move(*other);
}

Identification assemble_chain(const OrderedMotion& ordered, std::vector<JointResult> links,
                              const ChainGeometry& geometry, const IdentifyOptions& options) {
  const SegmentMotion& root = ordered.motion.segments[ordered.tree.root];
  Identification result;
  result.root = root.name;
  result.joints = geometry.joints;
  for (std::size_t i = 0; i < result.joints.size(); ++i)
    result.joints[i].type_probabilities = links[i].joint.type_probabilities;
  result.loops = geometry.loops;
  result.places = geometry.places;
  result.search_method = method_of(options.engine);
  result.starts_from_search = geometry.starts_from_search;
  for (JointResult& link : links)
    if (link.search) result.searches.push_back(std::move(*link.search));
  list_unobservable(result.joints);
  result.dh = geometry.dh;
  result.links = geometry.links.empty() ? link_estimates(result.joints) : geometry.links;
  result.chain = build_chain(result.root, result.joints, result.dh, root.rotation.front());
  set_closures(result.chain, result.root, result.loops);
  set_tool(result.chain, result.places);
  return result;
}

/// The chain of both logs together, where the machine is known and the fit has a covariance.
std::optional<ChainUpdate> update_known(ChainGeometry& geometry, const IdentifyOptions& options) {
  if (!options.refine.known || !geometry.tracking) return std::nullopt;
  UpdatedGeometry updated = update_geometry(*options.refine.known, std::move(geometry));
  geometry = std::move(updated.geometry);
  geometry.links.clear();  // of the new log alone
  return std::move(updated.update);
}

std::vector<Finding> findings_about(const ChainUpdate& update, const TrackingModel& known) {
  if (!update.is_other_machine) return {};
  return {{.kind = FindingKind::other_machine,
           .severity = Severity::fault,
           .values = {{"changes", static_cast<int>(update.changes.size())},
                      {"sensors", static_cast<int>(known.sensors.size())}}}};
}

/// Findings in the order in which the faults were found: excluded parts, order, clocks.
void report_findings(Identification& result, const Session& session, const OrderedMotion& ordered,
                     const OrderReport& order, const ClockReport& clocks) {
  append(result.findings, session.findings());
  if (session.has_idle_sensors()) append(result.findings, groups_attached_to_world(ordered));
  append(result.findings, order.findings);
  append(result.findings, clocks.findings);
}

/// f -> -f with r -> -r is an exact symmetry of gyroscopes and accelerometers: only a magnetometer tells the sign.
std::vector<IdentificationNote> assumptions_of(const InsRecording& recording) {
  if (std::ranges::any_of(recording.sensors, &InsSensor::has_magnetometer)) return {};
  return {{IdentificationNoteKind::assumed_force_sign, {}}};
}

void draw_conclusions(Identification& result, const OrderedMotion& ordered,
                      const std::vector<PairConnection>& connections) {
  result.forecast = forecast(result.joints, result.target);
  result.prediction = summarise_prediction(result.motion);
  result.verdicts = joint_verdicts(result, ordered, connections);
  result.usability = usability(result.findings, result.joints, result.verdicts);
  withdraw_unconnected(result);
  result.advice = identification_advice(result);
}

/// The recording of the named sensors, so that others are not judged; none if none is named.
Result<std::optional<InsRecording>> named_part(const InsRecording& log, const std::vector<std::string>& names) {
  if (names.empty()) return std::nullopt;
  KINFER_TRY(sensors, find_sensors(log, names));
  return select_sensors(log, sensors);
}

/// The same recording without the given tree judges the links that it contradicts.
void judge_given_links(Identification& given, const InsRecording& recording, IdentifyOptions options, const Rng& rng,
                       const Observer& observer) {
  if (!contradicts_given_links(given)) return;
  options.tree.clear();
  options.refine.known.reset();
  options.refine.start = StartSource::pairs;
  if (const auto estimated = identify_machine(recording, options, rng, observer)) weigh_given_links(given, *estimated);
}

/// The options with the structure of the known machine in place of one that is searched.
Result<IdentifyOptions> with_known_structure(const InsRecording& log, IdentifyOptions options) {
  if (!options.refine.known) return options;
  const TrackingModel& known = *options.refine.known;
  if (const auto checked = check_sensors(known, log); !checked) return forward_error(checked.error());
  options.sensors = sensor_names(known);
  options.root = root_sensor(known);
  options.tree = links_of(known);
  options.refine.start = StartSource::known;
  return options;
}

/// The known machine's joints take the order of the recording's segments.
void take_order(IdentifyOptions& options, const OrderedMotion& ordered) {
  if (options.refine.known)
    options.refine.known = in_order_of(ordered.tree, segment_names(ordered.motion), *options.refine.known);
}

Result<void> check_known(const IdentifyOptions& options, const InsRecording& used) {
  if (!options.refine.known) return {};
  std::vector<std::string> names;
  for (const InsSensor& sensor : used.sensors) names.push_back(sensor.name);
  return check_segments(*options.refine.known, names);
}

/// Sensors that are not part of the selection.
std::vector<std::size_t> left_out(const RecordingSelection& part, std::size_t sensors) {
  std::vector<std::size_t> result;
  for (std::size_t s = 0; s < sensors; ++s)
    if (std::ranges::find(part.sensors, s) == part.sensors.end()) result.push_back(s);
  return result;
}

/// Takes the biases that a fit has told to gyroscopes that never rest; false: all that is found with them is found.
/// Such a gyroscope drifts away from the others, which passes for motion: one of a consumer grade turns a hinge into a
/// ball joint within half a minute.
bool update_biases(LogDiagnosis& diagnosis, const ChainGeometry& geometry, const InsRecording& recording,
                   const IdentifyOptions& options) {
  if (!geometry.tracking || options.refine.known || diagnosis.bias_updates >= max_bias_updates) return false;
  std::vector<GyroscopeBias> told = told_biases(*geometry.tracking, recording, options.refine.common);
  if (std::ranges::all_of(told, [&](const GyroscopeBias& bias) { return agrees_with_one_of(diagnosis.biases, bias); }))
    return false;
  diagnosis.biases = std::move(told);
  ++diagnosis.bias_updates;
  return true;
}

/// `log`: the named sensors alone.
Result<Identification> identify_diagnosed(const InsRecording& log, LogDiagnosis diagnosis, IdentifyOptions options,
                                          const Rng& rng, const Observer& observer) {
  const InsRecording& recording = diagnosis.of(log);
  options.refine.common = diagnosis.scales;
  options.motion.biases = diagnosis.biases;
  KINFER_TRY(session, Session::open(recording, options.sensors, options.root, options.motion, options.threads));
  for (;;) {
    if (const auto known = check_known(options, session.recording()); !known) return forward_error(known.error());
    KINFER_TRY(ordered,
               order_segments(session.recording(), options.motion, options.root, options.threads, options.tree));
    const auto connections = tree_connections(ordered.motion, ordered.tree, options.threads);
    if (auto part = find_consistent_part(ordered, connections, options)) {
      const auto unconnected = left_out(*part, session.recording().sensors.size());
      if (mend_unconnected_axes(diagnosis, log, session.recording(), unconnected, options.threads))
        return identify_diagnosed(log, std::move(diagnosis), std::move(options), rng, observer);
      name_mixed_recording(*part, session.recording(), options.motion, options.threads);
      if (const auto done = session.restrict_to(std::move(*part)); !done) return forward_error(done.error());
      continue;
    }
    take_order(options, ordered);
    KINFER_TRY(links, initial_joints(ordered, connections, options, rng, observer));
    KINFER_TRY(geometry, final_geometry(links, session, ordered, connections, options, observer));
    if (session.update_clocks(geometry.clocks)) continue;
    if (update_biases(diagnosis, geometry, session.recording(), options))
      return identify_diagnosed(log, std::move(diagnosis), std::move(options), rng, observer);
    if (!geometry.tracking && !options.refine.zeros.empty())
      return error("--zero: no joint positions were found in this recording");

    std::optional<ChainUpdate> update = update_known(geometry, options);
    Identification result = assemble_chain(ordered, std::move(links), geometry, options);
    result.motion = motion_evidence(ordered.motion, result, geometry.held_out);
    OrderReport order = report_order(ordered, geometry.loops);
    ClockReport clocks = session.report_clocks(geometry.clocks, groups_on_ground(ordered));
    append(result.findings, diagnosis.findings);
    report_findings(result, session, ordered, order, clocks);
    append(result.findings, geometry.findings);
    if (update) append(result.findings, findings_about(*update, *options.refine.known));
    result.update = std::move(update);
    result.notes = std::move(order.notes);
    append(result.notes, geometry.notes);
    append(result.notes, assumptions_of(session.recording()));
    result.order = std::move(order.evidence);
    result.clocks = std::move(clocks.clocks);
    if (geometry.tracking)
      result.tracking = complete(std::move(*geometry.tracking), result, session.recording(), options.refine.common);
    judge_given_links(result, log, options, rng, observer);
    draw_conclusions(result, ordered, connections);
    return result;
  }
}

}  // namespace

Result<Identification> identify_machine(const InsRecording& log, const IdentifyOptions& given, const Rng& rng,
                                        const Observer& observer) {
  if (const auto checked = check(given); !checked) return forward_error(checked.error());
  KINFER_TRY(options, with_known_structure(log, given));
  KINFER_TRY(named, named_part(log, options.sensors));
  const InsRecording& part = named ? *named : log;
  KINFER_TRY(diagnosis, diagnose_log(part, options.threads));
  return identify_diagnosed(part, std::move(diagnosis), std::move(options), rng, observer);
}

}  // namespace kinfer::identify
