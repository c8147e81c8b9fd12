// SPDX-License-Identifier: Apache-2.0
// Where the joints of a chain are, and where other set-ups mount it.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

double frame_distance(const Pose& a, const Pose& b) {
  return std::max((a.position - b.position).norm(), (a.rotation - b.rotation).norm());
}

TEST(Placement, EveryJointMovesAboutOrAlongItsAxis) {
  for (const Chain& chain : laws::examples()) {
    Rng rng(3);
    for (const Joint& joint : chain.joints) {
      const Pose parent{exp_so3(test::random_vector(rng)), test::random_vector(rng)};
      const JointPlacement here = place_joint(parent, joint, 0.3), there = place_joint(parent, joint, 0.3 + 0.8);
      Pose motion;  // of the world, about a line or along a direction
      if (rotates(joint.type)) {
        motion.rotation = exp_so3(0.8 * here.axis);
        motion.position = here.point - motion.rotation * here.point;
      } else if (translates(joint.type)) {
        motion.position = 0.8 * here.axis;
      }
      EXPECT_NEAR(here.axis.norm(), has_position(joint.type) ? 1.0 : 0.0, 1e-14);
      EXPECT_LT(frame_distance(motion * here.frame, there.frame), 1e-13) << chain.name << ' ' << joint.name;
    }
  }
}

TEST(Placement, AxesAndPointsAreCarriedByTheJointBefore) {
  for (const Chain& chain : laws::examples_with_joints()) {
    const VectorXd q = laws::random_q(chain, Rng(9));
    const std::vector<JointPlacement> placed = joint_placements(chain, q);
    const std::vector<Pose> frames = joint_frames(chain, q);
    for (std::size_t j = 0; j < placed.size(); ++j) EXPECT_LT(frame_distance(placed[j].frame, frames[j]), 1e-15);
  }
}

TEST(Mounting, ReplacesBaseToolAndTipWhereItHasItsOwn) {
  Chain chain = laws::two_arms();
  const Frame stand = Frame::from_pose(Pose::from_xyz_rpy({2, 0, 1}, {0.1, 0.2, 0.3}));
  const Frame gripper = Frame::from_pose(Pose::from_xyz_rpy({0, 0, 0.2}, {0, 0.5, 0}));
  chain.mountings = {{.name = "stand", .base = stand, .tool = gripper, .tip = -1},
                     {.name = "left", .base = {}, .tool = gripper, .tip = 5}};
  const VectorXd q = laws::random_q(chain, Rng(2));
  EXPECT_LT(frame_distance(forward(with_mounting(chain, -1), q), forward(chain, q)), 1e-16);
  const Pose flange = chain.base.pose().inverse() * forward(chain, q) * chain.tool.pose().inverse();
  EXPECT_LT(frame_distance(forward(with_mounting(chain, 0), q), stand.pose() * flange * gripper.pose()), 1e-14);
  EXPECT_LT(frame_distance(forward(with_mounting(chain, 1), q), joint_frames(chain, q)[5] * gripper.pose()), 1e-14);
}

TEST(Mounting, FoldingSmallRotationsMovesNoFrameAndNoPlane) {
  Chain chain = laws::two_arms();
  const Frame frame{.xyz = {1, 2, 3}, .rotation = from_rpy({0.3, 0.2, 0.1}), .small_rotation = {0.02, -0.03, 0.04}};
  chain.mountings = {{.name = "other", .base = frame, .tool = frame, .tip = 5}};
  chain.fixtures.planes = {{"table", rot_x(0.4), Vec3(0.01, -0.02, 0.0), 0.3}};
  const Chain folded = with_small_rotations_folded(chain);
  EXPECT_EQ(folded.mountings[0].base->small_rotation.norm() + folded.mountings[0].tool.small_rotation.norm(), 0.0);
  EXPECT_LT(frame_distance(folded.mountings[0].base->pose(), frame.pose()), 1e-15);
  EXPECT_LT(frame_distance(folded.mountings[0].tool.pose(), frame.pose()), 1e-15);
  EXPECT_EQ(folded.fixtures.planes[0].small_rotation.norm(), 0.0);
  EXPECT_LT((folded.fixtures.planes[0].normal() - chain.fixtures.planes[0].normal()).norm(), 1e-15);
  EXPECT_EQ(folded.fixtures.planes[0].offset, 0.3);
}

TEST(Mounting, NormalOfAPlaneIsItsRotatedZ) {
  Plane plane;
  EXPECT_EQ(plane.normal(), Vec3::UnitZ());
  plane.rotation = rot_x(0.5);
  EXPECT_LT((plane.normal() - Vec3(0, -std::sin(0.5), std::cos(0.5))).norm(), 1e-15);
  plane.small_rotation.x() = 0.25;  // about the same axis: the angles add up
  EXPECT_LT((plane.normal() - Vec3(0, -std::sin(0.75), std::cos(0.75))).norm(), 1e-15);
}

}  // namespace
}  // namespace kinfer
