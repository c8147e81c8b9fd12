// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/searched_joint.hpp"

#include "identify/driven_machine.hpp"
#include "kinfer/identify/joints/thresholds.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::identified;

const LinkEvidence& search_of(const Identification& found, const std::string& segment) {
  return *std::ranges::find(found.searches, segment, &LinkEvidence::segment);
}

TEST(Certificate, TheWrittenJointsPredictTheHeldOutRowsAsWellAsTheSearchesOwn) {
  std::vector<InsRecording> recordings{test::driven_arm(4, 4).recording};
  if (!test::is_instrumented) recordings.push_back(test::driven_machine("robot6", 4).recording);
  for (const InsRecording& recording : recordings) {
    const Identification found = identified(recording);
    EXPECT_FALSE(found.starts_from_search);
    for (const JointEstimate& joint : found.joints) {
      const LinkEvidence& search = search_of(found, joint.child);
      ASSERT_TRUE(search.written_holdout);
      EXPECT_LT(search.written_holdout->total, min_search_advantage * search.holdout.total) << joint_name(joint);
    }
  }
}

TEST(Certificate, OfAWrongJointFails) {
  const InsRecording recording = test::driven_arm(4, 4).recording;
  const Identification found = identified(recording);
  const auto ordered = order_segments(recording, {}, {}, 1);
  ASSERT_TRUE(ordered);
  const auto segment = [&](const std::string& name) -> const SegmentMotion& {
    return *std::ranges::find(ordered->motion.segments, name, &SegmentMotion::name);
  };
  JointEstimate joint = *std::ranges::find(found.joints, "ins3", &JointEstimate::child);
  const auto rows = informative_rows(
      ordered->motion, static_cast<std::size_t>(&segment(joint.parent) - ordered->motion.segments.data()),
      static_cast<std::size_t>(&segment(joint.child) - ordered->motion.segments.data()), JointVariableKind::hinge);
  const auto cost = [&] {
    return fit_of_joint(joint, segment(joint.parent), segment(joint.child), rows, OrientationMetric::chord).total;
  };
  const double sound = cost();
  EXPECT_NEAR(sound, search_of(found, "ins3").written_holdout->total, 0.3 * sound);
  joint.point_in_child += 0.2 * any_perpendicular(joint.axis_in_child).normalized();
  EXPECT_GT(cost(), min_search_advantage * sound) << "0.2 m beside the axis";
}

TEST(StartOfTheFit, PairsOfSensorsAndSearchesLeadToTheSameOptimum) {
  const InsRecording recording = test::driven_arm(6, 4).recording;
  IdentifyOptions from_search;
  from_search.refine.start = StartSource::search;
  const Identification a = identified(recording), b = identified(recording, from_search);
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    const Vec3 apart = a.joints[i].point_in_child - b.joints[i].point_in_child;
    EXPECT_LT(apart.cross(a.joints[i].axis_in_child).norm(), 0.5 * (1e-4 + a.joints[i].sd.point_in_child[0]));
    EXPECT_LT(a.joints[i].axis_in_child.cross(b.joints[i].axis_in_child).norm(), 1e-3);
  }
}

}  // namespace
}  // namespace kinfer
