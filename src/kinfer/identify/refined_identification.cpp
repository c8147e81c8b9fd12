#include "kinfer/identify/refined_identification.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/identify/hidden_words.hpp"

namespace kinfer {
namespace {

std::size_t segment_named(const RecordedMotion& motion, const std::string& name) {
  const auto found = std::ranges::find(motion.segments, name, &SegmentMotion::name);
  KINFER_EXPECT(found != motion.segments.end(), "no segment {}", name);
  return static_cast<std::size_t>(found - motion.segments.begin());
}

constexpr double sensor_misfit = 3.0;  // times its own noise that a sensor leaves unexplained

/// A sentence for each sensor that the chain does not explain.
void say_misfits(std::vector<std::string>& notes, const Refinement& refined, const RecordedMotion& motion) {
  for (std::size_t s = 0; s < refined.noise.size(); ++s) {
    const double force = refined.noise[s].force / refined.least[s].force,
                 rate = refined.noise[s].rate / refined.least[s].rate;
    if (std::max(force, rate) < sensor_misfit) continue;
    notes.push_back(fmt::format(
        "the chain leaves {:.1f} times its noise of the specific force of {} unexplained ({:.3f} m/s²) and "
        "{:.1f} times of its rate: a soft mount, a play in a joint, a loop, a sensor that was remounted, or "
        "a wrong tree; the standard deviations have grown with it",
        force, motion.segments[s].name, refined.noise[s].force, rate));
  }
}

/// Which part of the motion was believed, and which joints are none in the strict sense.
void say_what_was_believed(std::vector<std::string>& notes, const Refinement& refined) {
  constexpr double notable_stray = 0.01;  // [rad]
  if (refined.cutoff > 0.0)
    notes.push_back(fmt::format(
        "faster motion is not that of a rigid chain: the geometry comes from the motion below {:.1f} Hz, and its "
        "standard deviations contain what a wider band would change",
        refined.cutoff));
  for (const RefinedJoint& joint : refined.joints)
    if (joint.stray > notable_stray)
      notes.push_back(
          fmt::format("the joint {}-{} is no pure hinge: its axis strays by {:.1f} degrees (rms), by play in the "
                      "bearing, a twisting "
                      "segment or a mount that gives way; it was fitted as a joint that turns freely, and the axis "
                      "stated is the mean",
                      joint.found.parent, joint.found.child, Angle::rad(joint.stray).deg()));
}

}  // namespace

Result<RefinedGeometry> refine_geometry(Identification& result, const InsRecording& recording,
                                        const RecordedMotion& motion, const SegmentTree& tree,
                                        const RefineOptions& options, const Observer& observer) {
  std::vector<JointStart> starts;
  for (const FoundJoint& joint : result.joints)
    starts.push_back(
        joint_start(motion, tree, segment_named(motion, joint.parent), segment_named(motion, joint.child), joint.type));
  auto refined = refine(recording, motion, tree, starts, options, observer);
  if (!refined && !options.facts.empty()) return pass_on(refined.error());
  if (!refined) {
    result.notes.push_back(refined.error().what + "; the geometry is the search's");
    return RefinedGeometry{};
  }
  result.joints.clear();
  result.dh.clear();
  for (const RefinedJoint& joint : refined->joints) {
    result.joints.push_back(joint.found);
    std::ranges::copy(canonical_rows(joint.found, joint.hinge), std::back_inserter(result.dh));
  }
  say_what_is_hidden(result.joints);
  say_misfits(result.notes, *refined, motion);
  say_what_was_believed(result.notes, *refined);
  result.places = refined->places;
  return RefinedGeometry{std::move(refined->clocks), std::move(refined->held_out)};
}

}  // namespace kinfer
