// SPDX-License-Identifier: Apache-2.0
#include "identify/telescope_machine.hpp"

#include <gmock/gmock.h>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/identify/structure/ordered_motion.hpp"
#include "kinfer/identify/structure/slide_fit.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "repeats.hpp"

namespace kinfer {
using namespace identify;
namespace {

TEST(SlideFit, CoriolisAccelerationsOfASlideTellOfAPrismaticJoint) {
  const test::TelescopeMachine machine(0.3, 0.01, 1);
  const auto ordered = order_segments(machine.recording, {}, "ins0", 1);
  ASSERT_TRUE(ordered);
  const auto slide = fit_slide(ordered->motion, ordered->motion.segments[2], ordered->motion.segments[3]);
  ASSERT_TRUE(slide);
  EXPECT_GT(std::sqrt(symmetric_eigen(ordered->tree.pair(2, 3).acceleration).values[1]), 0.5) << "across the slide";
  EXPECT_LT(slide->residual, 0.06);
  EXPECT_LT(slide->axis_in_parent.cross(Vec3::UnitX()).norm(), 0.01);
  const Vec3 across = slide->offset_in_parent - Vec3(0.7, -0.1, 0.0);
  EXPECT_LT(across.tail<2>().norm(), 0.01);
}

TEST(SlideFit, WithoutMotionThereIsNone) {
  const RecordedMotion none;
  EXPECT_FALSE(fit_slide(none, SegmentMotion{}, SegmentMotion{}));
}

TEST(TelescopeMachine, IsOneMachineWithAPrismaticJointAtAnyRateAndTravel) {
  struct Case {
    double travel, period;
  };
  for (const Case& c : test::repeats({Case{0.1, 0.005}, Case{0.1, 0.01}, Case{0.3, 0.01}})) {
    SCOPED_TRACE(testing::Message() << c.travel << " m, " << 1.0 / c.period << " Hz");
    const test::TelescopeMachine machine(c.travel, c.period, 1);
    const auto found = identify_machine(machine.recording, {}, Rng(1));
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_THAT(found->findings, testing::IsEmpty());
    ASSERT_EQ(found->joints.size(), 4U);
    EXPECT_EQ(found->joints[2].type, EstimatedJointType::prismatic);
    EXPECT_LT(found->joints[2].axis_in_parent.cross(Vec3::UnitX()).norm(), 3e-3);
  }
}

}  // namespace
}  // namespace kinfer
