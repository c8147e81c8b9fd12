#include "kinfer/identify/refined_identification.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

std::size_t segment_named(const RecordedMotion& motion, const std::string& name) {
  const auto found = std::ranges::find(motion.segments, name, &SegmentMotion::name);
  KINFER_EXPECT(found != motion.segments.end(), "no segment {}", name);
  return static_cast<std::size_t>(found - motion.segments.begin());
}

}  // namespace

Result<void> refine_geometry(Identification& result, const InsRecording& recording, const RecordedMotion& motion,
                             const SegmentTree& tree, const RefineOptions& options, const Observer& observer) {
  std::vector<JointStart> starts;
  for (const FoundJoint& joint : result.joints)
    starts.push_back(
        joint_start(motion, tree, segment_named(motion, joint.parent), segment_named(motion, joint.child), joint.type));
  auto refined = refine(recording, motion, tree, starts, options, observer);
  if (!refined && !options.facts.empty()) return pass_on(refined.error());
  if (!refined) {
    result.notes.push_back(refined.error().what + "; the geometry is the search's");
    return {};
  }
  result.joints.clear();
  result.dh.clear();
  for (const RefinedJoint& joint : refined->joints) {
    result.joints.push_back(joint.found);
    std::ranges::copy(canonical_rows(joint.found, joint.hinge), std::back_inserter(result.dh));
  }
  result.places = refined->places;
  return {};
}

}  // namespace kinfer
