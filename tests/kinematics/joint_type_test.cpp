// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/joint_type.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/frame_motion.hpp"

namespace kinfer {
namespace {

Chain single_joint(JointType type, const Link& link) {
  Chain chain;
  chain.joints = {{.name = "J1", .type = type, .link = link, .is_active = has_position(type)}};
  return chain;
}

TEST(JointTypes, EachIsFoundByItsName) {
  for (const JointTypeTraits& row : joint_types) {
    EXPECT_EQ(joint_type_named(row.name), row.type);
    EXPECT_EQ(&traits(row.type), &row);
    EXPECT_NE(joint_type_names().find("\"" + std::string(row.name) + "\""), std::string::npos);
  }
  EXPECT_FALSE(joint_type_named("helical").has_value());
  EXPECT_FALSE(joint_type_named("").has_value());
}

TEST(JointTypes, ThePositionIsAnAngleOrALengthOrThereIsNone) {
  for (const JointTypeTraits& row : joint_types) {
    EXPECT_EQ(has_position(row.type), rotates(row.type) != translates(row.type)) << row.name;
    EXPECT_EQ(has_position(row.type), !row.mjcf.empty()) << row.name;
    EXPECT_FALSE(row.urdf.empty() || row.urdf_unlimited.empty()) << row.name;
  }
}

TEST(JointTypes, EachMovesAboutOrAlongTheAxisOfItsLink) {
  const Vec3 axis = Vec3(1.0, -2.0, 2.0) / 3.0;
  const double q = 0.3;
  const std::pair<Link, Vec3> links[] = {
      {UrdfLink{.origin = {}, .axis = axis}, axis}, {DhLink{}, Vec3::UnitZ()}, {MdhLink{}, Vec3::UnitZ()}};
  for (const JointTypeTraits& row : joint_types)
    for (const auto& [link, along] : links) {
      const Chain chain = single_joint(row.type, link);
      const int variables = has_position(row.type) ? 1 : 0;
      ASSERT_EQ(dof(chain), variables) << row.name;
      const Pose moved = forward(chain, VectorXd::Constant(variables, q));
      const Vec3 turned = rotates(row.type) ? Vec3(q * along) : Vec3(Vec3::Zero()),
                 shifted = translates(row.type) ? Vec3(q * along) : Vec3(Vec3::Zero());
      EXPECT_LT((log_so3(moved.rotation) - turned).norm(), 1e-12) << row.name;
      EXPECT_LT((moved.position - shifted).norm(), 1e-12) << row.name;
    }
}

TEST(JointTypes, EachHasTheTwistOfItsMotion) {
  const Vec3 axis = Vec3(2.0, 1.0, -2.0) / 3.0, tool(0.4, -0.1, 0.2);
  for (const JointTypeTraits& row : joint_types) {
    if (!has_position(row.type)) continue;
    Chain chain = single_joint(row.type, UrdfLink{.origin = {}, .axis = axis});
    chain.tool.xyz = tool;
    const MatrixXd found = jacobian(chain, VectorXd::Zero(1));
    const Vec3 velocity = rotates(row.type) ? axis.cross(tool) : axis,
               spin = rotates(row.type) ? axis : Vec3::Zero().eval();
    EXPECT_LT((found.col(0).head<3>() - velocity).norm(), 1e-12) << row.name;
    EXPECT_LT((found.col(0).tail<3>() - spin).norm(), 1e-12) << row.name;
  }
}

TEST(JointTypes, AFixedJointPassesTheMotionOfItsParentOn) {
  Chain chain = single_joint(JointType::revolute, UrdfLink{});
  chain.joints.push_back({.name = "F",
                          .parent = 0,
                          .type = JointType::fixed,
                          .link = UrdfLink{.origin = {.xyz = {1.0, 0.0, 0.0}}},
                          .is_active = false});
  const VectorXd q = VectorXd::Constant(1, 0.0), qd = VectorXd::Constant(1, 2.0), qdd = VectorXd::Constant(1, 0.5);
  const FrameMotion tip = joint_motions(chain, q, qd, qdd).back();
  EXPECT_LT((tip.pose.position - Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((tip.velocity - Vec3(0, 2, 0)).norm(), 1e-12);
  EXPECT_LT((tip.acceleration - Vec3(-4, 0.5, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace kinfer
