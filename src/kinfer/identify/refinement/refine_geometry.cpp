// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refine_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/identify/geometry/link_estimates.hpp"
#include "kinfer/identify/handover/known_joint.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"
#include "kinfer/identify/refinement/scales/scale_findings.hpp"

namespace kinfer::identify {
namespace {

std::size_t segment_named(const RecordedMotion& motion, const std::string& name) {
  const auto segment = std::ranges::find(motion.segments, name, &SegmentMotion::name);
  KINFER_EXPECT(segment != motion.segments.end(), "no segment {}", name);
  return static_cast<std::size_t>(segment - motion.segments.begin());
}

/// A note for each sensor whose motion the chain does not explain.
void add_misfit_notes(std::vector<IdentificationNote>& notes, const Refinement& refined, const RecordedMotion& motion) {
  for (std::size_t s = 0; s < refined.noise.size(); ++s) {
    const double force = refined.noise[s].force / refined.noise_floor[s].force,
                 rate = refined.noise[s].angular_velocity / refined.noise_floor[s].angular_velocity;
    if (std::max(force, rate) < max_sensor_misfit) continue;
    notes.push_back({IdentificationNoteKind::unexplained_motion,
                     {{"sensor", motion.segments[s].name},
                      {"force_ratio", force},
                      {"rate_ratio", rate},
                      {"force_noise", refined.noise[s].force}}});
  }
}

/// Notes on the passband that was used, and on joints that are not strictly revolute.
void add_passband_notes(std::vector<IdentificationNote>& notes, const Refinement& refined) {
  if (refined.cutoff > 0.0) notes.push_back({IdentificationNoteKind::limited_passband, {{"cutoff", refined.cutoff}}});
  for (const RefinedJoint& joint : refined.joints)
    if (joint.mean && joint.mean->axis_deviation > min_reported_axis_deviation)
      notes.push_back({IdentificationNoteKind::relaxed_joint,
                       {{"parent", joint.estimate.parent},
                        {"child", joint.estimate.child},
                        {"axis_deviation", joint.mean->axis_deviation}}});
}

std::vector<InitialJoint> known_starts(const TrackingModel& known, const RecordedMotion& motion,
                                       const SegmentTree& tree) {
  std::vector<InitialJoint> starts;
  for (const KnownJoint& joint : known_joints(known))
    starts.push_back(initial_joint_from(motion, tree, segment_named(motion, joint.parent),
                                        segment_named(motion, joint.child), joint.type, joint.bodies));
  return starts;
}

std::vector<InitialJoint> make_starts(const std::vector<JointEstimate>& joints, const RecordedMotion& motion,
                                      const SegmentTree& tree, const RefinementOptions& options) {
  if (options.start == StartSource::known) return known_starts(*options.known, motion, tree);
  std::vector<InitialJoint> starts;
  for (const JointEstimate& joint : joints) {
    const std::size_t parent = segment_named(motion, joint.parent), child = segment_named(motion, joint.child);
    const bool from_search = options.start == StartSource::search && joint.type == EstimatedJointType::revolute;
    starts.push_back(from_search ? initial_joint_at(motion, parent, child, joint)
                                 : estimate_initial_joint(motion, tree, parent, child, joint.type));
  }
  return starts;
}

/// An azimuth turns both joints of a link about the axis of the first one.
std::vector<JointEstimate> joints_of_known_azimuth(const std::vector<RefinedJoint>& refined) {
  std::vector<JointEstimate> joints;
  for (const RefinedJoint& joint : refined) {
    joints.push_back(joint.estimate);
    joints.back().sd = joint.solution.precision.sd;
  }
  return joints;
}

/// The lengths of the search are those of one of both explanations, gyroscopes or clock, and no fit holds the others.
void doubt_searched_lengths(ChainGeometry& searched, const InsCommonScale& rate) {
  searched.findings.push_back(clock_rate_finding(rate.factor - 1.0, rate.factor * rate.sd, Severity::fault));
  const double change = 1.0 / (rate.factor * rate.factor) - 1.0;
  for (JointEstimate& joint : searched.joints)
    for (auto [sd, point] : {std::pair{&joint.sd.point_in_parent, joint.point_in_parent},
                             std::pair{&joint.sd.point_in_child, joint.point_in_child}})
      for (double& value : *sd) value = std::hypot(value, change * point.norm());
}

}  // namespace

Result<ChainGeometry> refine_geometry(ChainGeometry searched, const InsRecording& recording,
                                      const RecordedMotion& motion, const SegmentTree& tree,
                                      const RefinementOptions& options, const Observer& observer) {
  const auto starts = make_starts(searched.joints, motion, tree, options);
  auto refined = refine(recording, motion, tree, starts, options, observer);
  if (!refined && !(options.facts.empty() && options.zeros.empty() && !options.known))
    return forward_error(refined.error());
  if (!refined) {
    searched.notes.push_back({IdentificationNoteKind::refinement_failed, {{"reason", refined.error().what}}});
    if (!options.common.gyroscope.is_none()) doubt_searched_lengths(searched, options.common.gyroscope);
    return searched;
  }
  ChainGeometry geometry{.joints = {}, .dh = {}, .loops = {}, .places = std::move(refined->places)};
  for (const RefinedJoint& joint : refined->joints) {
    geometry.joints.push_back(joint.estimate);
    std::ranges::copy(canonical_dh_rows(joint.estimate, joint.solution), std::back_inserter(geometry.dh));
  }
  geometry.links = link_estimates(joints_of_known_azimuth(refined->joints));
  geometry.notes = std::move(searched.notes);
  add_misfit_notes(geometry.notes, *refined, motion);
  add_passband_notes(geometry.notes, *refined);
  geometry.clocks = std::move(refined->clocks);
  geometry.negative_log_likelihood = refined->negative_log_likelihood;
  geometry.loops = std::move(refined->loops);
  geometry.findings = std::move(refined->findings);
  geometry.held_out = std::move(refined->held_out);
  geometry.tracking = std::move(refined->tracking);
  return geometry;
}

}  // namespace kinfer::identify
