// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/dh_conversion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using laws::urdf;

/// A chain of URDF joints about or along the given lines, all at q = 0 in the world's orientation.
Chain chain_of_lines(const std::vector<AxisLine>& lines) {
  Chain chain;
  chain.name = "lines";
  Vec3 before = Vec3::Zero();
  for (const AxisLine& line : lines) {
    chain.joints.push_back(urdf(line.is_prismatic ? JointType::prismatic : JointType::revolute, line.point - before,
                                Vec3::Zero(), line.direction));
    chain.joints.back().parent = static_cast<int>(chain.joints.size()) - 2;
    before = line.point;
  }
  chain.tool.xyz = {0.1, 0.2, 0.3};
  return chain;
}

std::vector<AxisLine> random_lines(int count, Rng rng) {
  std::vector<AxisLine> lines;
  for (int i = 0; i < count; ++i) {
    const Vec3 point = test::random_vector(rng), direction = test::random_vector(rng);
    lines.push_back({point, direction.normalized(), i > 0 && rng.uniform() < 0.3});
  }
  return lines;
}

/// Both conversions reach the same tool poses as the chain, by rows of their own kind only.
void expect_same_machine(const Chain& chain) {
  const std::optional<Chain> mdh = as_mdh(chain), dh = as_dh(chain);
  ASSERT_TRUE(mdh && dh) << chain.name;
  ASSERT_EQ(mdh->joints.size(), static_cast<std::size_t>(dof(chain)));
  for (const Joint& joint : mdh->joints) EXPECT_TRUE(std::holds_alternative<MdhLink>(joint.link));
  for (const Joint& joint : dh->joints) EXPECT_TRUE(std::holds_alternative<DhLink>(joint.link));
  EXPECT_EQ(active_joint_names(*mdh), active_joint_names(chain));
  for (std::uint64_t k = 0; k < 10; ++k) {
    const VectorXd q = laws::random_q(chain, Rng(3).stream(k));
    const Pose expected = forward(chain, q);
    for (const Chain& converted : {*mdh, *dh}) {
      const Pose pose = forward(converted, q);
      EXPECT_LT((pose.position - expected.position).norm(), 1e-9) << chain.name;
      EXPECT_LT((pose.rotation - expected.rotation).norm(), 1e-9) << chain.name;
    }
  }
}

TEST(DhConversion, EverySerialExampleKeepsItsToolPoses) {
  int converted = 0;
  for (Chain chain : laws::examples()) {
    chain.masses.clear();
    if (!is_serial_chain(chain)) continue;
    ++converted;
    expect_same_machine(chain);
  }
  EXPECT_GE(converted, 8);
}

TEST(DhConversion, MachinesWithAnyAxesKeepTheirToolPoses) {
  for (std::uint64_t k = 0; k < 40; ++k) expect_same_machine(chain_of_lines(random_lines(6, Rng(11).stream(k))));
}

TEST(DhConversion, RowsOfConvertedRowsAreTheSameMachine) {
  for (std::uint64_t k = 0; k < 10; ++k) {
    const Chain chain = chain_of_lines(random_lines(5, Rng(12).stream(k)));
    expect_same_machine(*as_dh(*as_mdh(chain)));
    expect_same_machine(*as_mdh(*as_dh(chain)));
  }
}

TEST(DhConversion, SpecialAxesKeepTheToolPoses) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  const std::vector<std::vector<AxisLine>> cases{
      {{o, z, false}},                                                      // a turntable
      {{o, z, true}},                                                       // a slide
      {{o, z, true}, {x, z, false}, {2 * x, z, false}},                     // a slide first, then parallel axes
      {{o, z, true}, {o, x, true}, {o, y, true}},                           // a gantry
      {{o, z, false}, {o, z, false}, {z, z, true}},                         // coincident axes
      {{o, z, false}, {x, -z, false}, {2 * x + y, z, false}},               // antiparallel axes
      {{o, z, false}, {o, x, false}, {o, z, false}},                        // a spherical wrist
      {{o, z, false}, {0.3 * x, y, false}, {0.3 * x + z, y, false}},        // shoulder and elbow
      {{Vec3(3, 4, 5), x, false}, {Vec3(3, 4, 5), y, true}, {o, x, false}}  // far from the origin
  };
  for (const auto& lines : cases) expect_same_machine(chain_of_lines(lines));
}

/// Two horizontal axes 1 m apart that enclose this angle, and a third axis.
Chain elbow(double angle) {
  return chain_of_lines({{Vec3::Zero(), Vec3::UnitY(), false},
                         {Vec3::UnitX(), rot_z(angle) * Vec3::UnitY(), false},
                         {Vec3(2, 0, 0), Vec3::UnitX(), false}});
}

TEST(DhConversion, NearlyParallelAxesGetHayatisAngle) {
  // Intersecting lines: the common perpendicular is vertical and jumps 1/tan(angle) m away; Hayati's row stays near.
  for (const auto& [angle, has_beta] : {std::pair{1.9 * degree, true}, {-1.9 * degree, true}, {2.1 * degree, false}}) {
    const Chain chain = elbow(angle);
    expect_same_machine(chain);
    const auto row = std::get<MdhLink>(as_mdh(chain)->joints[1].link);
    EXPECT_NEAR(std::abs(row.beta), has_beta ? 1.9 * degree : 0.0, 1e-12);
    EXPECT_NEAR(row.a, has_beta ? 1.0 : 0.0, 1e-9);
    EXPECT_LT(std::abs(row.d), has_beta ? 1.0 : 30.0);
  }
}

TEST(DhConversion, TheEr20KeepsItsOwnNumbers) {
  // Base and tool absorb the first and the last offset, and the sense of an x axis is a choice; lengths are not.
  const Chain chain = laws::er20(), mdh = *as_mdh(chain);
  for (std::size_t j = 1; j < 6; ++j) {
    const auto was = std::get<MdhLink>(chain.joints[j].link), is = std::get<MdhLink>(mdh.joints[j].link);
    EXPECT_NEAR(std::abs(is.a), std::abs(was.a), 1e-12) << j;
    EXPECT_NEAR(std::abs(std::sin(is.alpha)), std::abs(std::sin(was.alpha)), 1e-12) << j;
    EXPECT_NEAR(is.beta, 0.0, 1e-12) << j;
  }
  EXPECT_NEAR(std::abs(std::get<MdhLink>(mdh.joints[3].link).d), 0.76135, 1e-12);
}

TEST(DhConversion, MachinesThatAreNoSerialChainHaveNoRows) {
  Chain forked = laws::two_arms();
  Chain passive = laws::er20();
  passive.joints[2].is_active = false;
  Chain belt = laws::er20();
  belt.joints[4].couplings = {{3, 0.5}};
  for (const Chain& chain : {forked, passive, belt, laws::coupled(), laws::without_joints()}) {
    EXPECT_FALSE(is_serial_chain(chain)) << chain.name;
    EXPECT_FALSE(as_mdh(chain)) << chain.name;
    EXPECT_FALSE(as_dh(chain)) << chain.name;
  }
  EXPECT_TRUE(is_serial_chain(laws::urdf_arm()));  // fixed joints do not count
}

TEST(AxisLines, AreThoseOfTheChainAtZero) {
  const std::vector<AxisLine> lines = axis_lines(laws::er20());
  ASSERT_EQ(lines.size(), 6u);
  const Pose base = laws::er20().base.pose();
  EXPECT_LT((lines[0].direction - base.rotation.col(2)).norm(), 1e-14);
  EXPECT_LT((lines[0].point - base.position).cross(lines[0].direction).norm(), 1e-14);
  for (const AxisLine& line : lines) {
    EXPECT_NEAR(line.direction.norm(), 1.0, 1e-14);
    EXPECT_NEAR(line.point.dot(line.direction), 0.0, 1e-14) << "nearest to the world's origin";
    EXPECT_FALSE(line.is_prismatic);
  }
  EXPECT_TRUE(axis_lines(laws::scara())[2].is_prismatic);
  EXPECT_EQ(axis_lines(laws::urdf_arm()).size(), 5u);
  EXPECT_EQ(axis_lines(laws::two_arms()).size(), 4u);  // on the path to the tool
  EXPECT_TRUE(axis_lines(laws::without_joints()).empty());
}

TEST(AxisLines, AreNearlyParallelWithinTwoDegrees) {
  const AxisLine up{Vec3::Zero(), Vec3::UnitZ(), false};
  for (const double turn : {0.0, 180.0}) {
    for (const double angle : {0.0, 1.9, -1.9})
      EXPECT_TRUE(nearly_parallel(up, {Vec3::UnitX(), rot_x((turn + angle) * degree) * Vec3::UnitZ(), false}));
    for (const double angle : {2.1, -2.1, 90.0})
      EXPECT_FALSE(nearly_parallel(up, {Vec3::UnitX(), rot_x((turn + angle) * degree) * Vec3::UnitZ(), false}));
  }
}

TEST(AxisLines, CommonNormalIsPerpendicularToBoth) {
  const AxisLine along_x{Vec3(7, 0, 0), Vec3::UnitX(), false}, post{Vec3(2, 3, 5), Vec3::UnitZ(), false};
  EXPECT_LT((common_normal_foot(along_x, post) - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((common_normal_foot(post, along_x) - Vec3(2, 3, 0)).norm(), 1e-15);
  for (std::uint64_t k = 0; k < 20; ++k) {
    const std::vector<AxisLine> lines = random_lines(2, Rng(13).stream(k));
    const Vec3 normal = common_normal_foot(lines[0], lines[1]) - common_normal_foot(lines[1], lines[0]);
    EXPECT_NEAR(normal.dot(lines[0].direction), 0.0, 1e-10);
    EXPECT_NEAR(normal.dot(lines[1].direction), 0.0, 1e-10);
  }
}

}  // namespace
}  // namespace kinfer
