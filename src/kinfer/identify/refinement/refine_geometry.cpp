// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/refine_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/identify/findings/unobservable.hpp"

namespace kinfer::identify {
namespace {

std::size_t segment_named(const RecordedMotion& motion, const std::string& name) {
  const auto segment = std::ranges::find(motion.segments, name, &SegmentMotion::name);
  KINFER_EXPECT(segment != motion.segments.end(), "no segment {}", name);
  return static_cast<std::size_t>(segment - motion.segments.begin());
}

constexpr double max_sensor_misfit = 3.0;  // residual noise over noise floor above which a sensor is reported

/// A note for each sensor that the chain does not explain.
void add_misfit_notes(std::vector<std::string>& notes, const Refinement& refined, const RecordedMotion& motion) {
  for (std::size_t s = 0; s < refined.noise.size(); ++s) {
    const double force = refined.noise[s].force / refined.noise_floor[s].force,
                 angular_velocity = refined.noise[s].angular_velocity / refined.noise_floor[s].angular_velocity;
    if (std::max(force, angular_velocity) < max_sensor_misfit) continue;
    notes.push_back(fmt::format(
        "the chain leaves {:.1f} times its noise of the specific force of {} unexplained ({:.3f} m/s²) and "
        "{:.1f} times of its rate: a soft mount, a play in a joint, a loop, a sensor that was remounted, or "
        "a wrong tree; the standard deviations have grown with it",
        force, motion.segments[s].name, refined.noise[s].force, angular_velocity));
  }
}

/// Notes on the passband that was used, and on joints that are not strictly revolute.
void add_passband_notes(std::vector<std::string>& notes, const Refinement& refined) {
  constexpr double min_axis_deviation = 0.01;  // [rad]
  if (refined.cutoff > 0.0)
    notes.push_back(fmt::format(
        "faster motion is not that of a rigid chain: the geometry comes from the motion below {:.1f} Hz, and its "
        "standard deviations contain what a wider band would change",
        refined.cutoff));
  for (const RefinedJoint& joint : refined.joints)
    if (joint.axis_deviation > min_axis_deviation)
      notes.push_back(
          fmt::format("the joint {}-{} is no pure hinge: its axis strays by {:.1f} degrees (rms), by play in the "
                      "bearing, a twisting "
                      "segment or a mount that gives way; it was fitted as a joint that turns freely, and the axis "
                      "stated is the mean",
                      joint.estimate.parent, joint.estimate.child, Angle::rad(joint.axis_deviation).deg()));
}

}  // namespace

Result<RefinementExtras> refine_geometry(Identification& result, const InsRecording& recording,
                                         const RecordedMotion& motion, const SegmentTree& tree,
                                         const RefinementOptions& options, const Observer& observer) {
  std::vector<InitialJoint> starts;
  for (const JointEstimate& joint : result.joints)
    starts.push_back(estimate_initial_joint(motion, tree, segment_named(motion, joint.parent),
                                            segment_named(motion, joint.child), joint.type));
  auto refined = refine(recording, motion, tree, starts, options, observer);
  if (!refined && !options.facts.empty()) return forward_error(refined.error());
  if (!refined) {
    result.notes.push_back(refined.error().what + "; the geometry is the search's");
    return RefinementExtras{};
  }
  result.joints.clear();
  result.dh.clear();
  for (const RefinedJoint& joint : refined->joints) {
    result.joints.push_back(joint.estimate);
    std::ranges::copy(canonical_dh_rows(joint.estimate, joint.solution), std::back_inserter(result.dh));
  }
  list_unobservable(result.joints);
  add_misfit_notes(result.notes, *refined, motion);
  add_passband_notes(result.notes, *refined);
  result.places = refined->places;
  return RefinementExtras{std::move(refined->clocks), std::move(refined->held_out)};
}

}  // namespace kinfer::identify
