// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/identified_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/random.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::random_vector;
using enum EstimatedJointType;

constexpr std::array all_joint_types{revolute, prismatic, universal, spherical, rigid};

JointGeometry random_geometry(Rng& rng) {
  JointGeometry g;
  g.home = {exp_so3(random_vector(rng)), random_vector(rng)};
  g.axis_in_parent = random_vector(rng).normalized();
  g.axis_in_child = random_vector(rng).normalized();
  g.point_in_parent = random_vector(rng);
  g.point_in_child = g.home.inverse() * g.point_in_parent;
  g.spherical_axes = exp_so3(random_vector(rng));
  return g;
}

TEST(DhRowToLine, BringsTheAxisOntoTheLine) {
  Rng rng(1);
  for (int k = 0; k < 300; ++k) {
    const Vec3 point = random_vector(rng);
    Vec3 direction = random_vector(rng).normalized();
    if (k % 3 == 1) direction = (Vec3::UnitZ() + 0.2 * rng.uniform() * direction).normalized();
    if (k % 3 == 2) direction = (-Vec3::UnitZ() + 0.2 * rng.uniform() * direction).normalized();
    const DhNumbers row = dh_row_to_line(point, direction);
    const Pose pose = transform(row);
    EXPECT_LT((pose.rotation.col(2) - direction).norm(), 1e-12) << k;
    EXPECT_LT((pose.position - point).cross(direction).norm(), 1e-10) << k;
    EXPECT_TRUE(row.d == 0.0 || row.beta == 0.0) << "four numbers tell a line";
    EXPECT_LT(std::abs(row.d), 50.0) << "also of nearly parallel lines";
  }
}

TEST(DhRowToLine, BetaReplacesDWhereTheLineIsNearlyParallel) {
  for (const double sine : {0.099, 0.101}) {
    const Vec3 direction(sine, 0.0, std::sqrt(1.0 - sine * sine));
    const DhNumbers row = dh_row_to_line(Vec3(0.3, -0.2, 0.5), direction);
    EXPECT_EQ(row.beta != 0.0, sine < 0.1);
    EXPECT_EQ(row.d == 0.0, sine < 0.1);
  }
  const DhNumbers along = dh_row_to_line(Vec3(0.0, 0.0, 4.0), Vec3::UnitZ());
  EXPECT_EQ(
      std::abs(along.a) + std::abs(along.alpha) + std::abs(along.beta) + std::abs(along.d) + std::abs(along.theta), 0.0)
      << "its own z";
}

TEST(JointAxes, EveryTypeHasAsManyAsItHasVariables) {
  Rng rng(2);
  const JointGeometry g = random_geometry(rng);
  EXPECT_EQ(joint_axes(revolute, g).size(), 1U);
  EXPECT_EQ(joint_axes(prismatic, g).size(), 1U);
  EXPECT_EQ(joint_axes(spherical, g).size(), 3U);
  EXPECT_EQ(joint_axes(rigid, g).size(), 1U);
  ASSERT_EQ(joint_axes(universal, g).size(), 2U);
  EXPECT_EQ(joint_axes(universal, g)[0], g.axis_in_parent);
  EXPECT_LT((g.home.rotation.transpose() * joint_axes(universal, g)[1] - g.axis_in_child).norm(), 1e-12)
      << "the second axis is fixed in the child";
}

TEST(JointDhRows, AreTheHomePoseAtJointPositionZero) {
  Rng rng(3);
  for (int k = 0; k < 20; ++k) {
    const JointGeometry g = random_geometry(rng);
    for (const EstimatedJointType type : all_joint_types) {
      const std::vector<DhNumbers> rows = joint_dh_rows(type, g);
      EXPECT_EQ(rows.size(), joint_axes(type, g).size() + 2);
      Pose pose;
      for (const DhNumbers& row : rows) pose = pose * transform(row);
      EXPECT_LT((pose.rotation - g.home.rotation).norm(), 1e-9) << name(type);
      EXPECT_LT((pose.position - g.home.position).norm(), 1e-8) << name(type);
    }
  }
}

TEST(JointDhRows, MoveAboutTheAxesThroughThePoint) {
  Rng rng(4);
  const JointGeometry g = random_geometry(rng);
  for (const EstimatedJointType type : {revolute, universal, spherical}) {
    std::vector<DhNumbers> rows = joint_dh_rows(type, g);
    const std::vector<Vec3> axes = joint_axes(type, g);
    Mat3 turn = Mat3::Identity();
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double q = 0.4 + 0.3 * static_cast<double>(k);
      rows[k + 1].theta += q;
      turn = turn * exp_so3(q * axes[k]);
    }
    Pose pose;
    for (const DhNumbers& row : rows) pose = pose * transform(row);
    EXPECT_LT((pose.rotation - turn * g.home.rotation).norm(), 1e-9) << name(type);
    EXPECT_LT((pose.position - g.point_in_parent - turn * (g.home.position - g.point_in_parent)).norm(), 1e-8);
  }
}

JointEstimate named_joint(const std::string& parent, const std::string& child, EstimatedJointType type = revolute) {
  return {.parent = parent, .child = child, .type = type};
}

std::vector<std::string> variables_of(EstimatedJointType type) {
  Rng rng(5);
  std::vector<std::string> names;
  for (const DhRowEstimate& row : canonical_dh_rows(named_joint("a", "b", type), {random_geometry(rng), {}}))
    names.push_back(row.variable());
  return names;
}

TEST(CanonicalRows, VariablesAreNamedAfterTheJoint) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(variables_of(revolute), (Names{"", "a-b", ""}));
  EXPECT_EQ(variables_of(prismatic), (Names{"", "a-b", ""}));
  EXPECT_EQ(variables_of(rigid), (Names{"", "", ""}));
  EXPECT_EQ(variables_of(universal), (Names{"", "a-b 1", "a-b 2", ""}));
  EXPECT_EQ(variables_of(spherical), (Names{"", "a-b 1", "a-b 2", "a-b 3", ""}));
}

TEST(LeafRows, NameTheSignalOfEachAngle) {
  std::vector<JointSignal> signals(2);
  signals[0].name = "phi", signals[1].name = "psi";
  const std::vector<DhLeaf> leaves{{.theta = 0.1, .d = 0.2, .alpha = 0.3, .a = 0.4},
                                   {.theta_signal = 1, .alpha_signal = 0}};
  const auto rows = leaf_dh_rows("arm", leaves, signals);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].segment, "arm");
  EXPECT_EQ(rows[0].row.a, 0.4);
  EXPECT_EQ(rows[0].row.theta, 0.1);
  EXPECT_EQ(rows[0].theta_variable + rows[0].alpha_variable, "");
  EXPECT_EQ(rows[1].theta_variable, "psi");
  EXPECT_EQ(rows[1].alpha_variable, "phi");
}

struct BuiltChain {
  std::vector<JointEstimate> joints;
  std::vector<JointGeometry> geometries;
  Chain chain;
};

/// Root a with limbs b-c and d.
BuiltChain branching_chain(const Mat3& world_R_root) {
  BuiltChain built;
  Rng rng(6);
  built.joints = {named_joint("a", "b"), named_joint("b", "c", spherical), named_joint("a", "d", rigid)};
  std::vector<DhRowEstimate> dh;
  for (const JointEstimate& joint : built.joints) {
    built.geometries.push_back(random_geometry(rng));
    for (const DhRowEstimate& row : canonical_dh_rows(joint, {built.geometries.back(), {}})) dh.push_back(row);
  }
  built.chain = build_chain("a", built.joints, dh, world_R_root);
  return built;
}

Pose frame_of(const Chain& chain, const std::vector<Pose>& frames, const std::string& sensor) {
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    if (chain.joints[i].name == sensor) return frames[i];
  ADD_FAILURE() << sensor;
  return {};
}

TEST(BuildChain, PutsEverySensorAtItsHomePose) {
  const Mat3 world_R_root = exp_so3(Vec3(0.1, 0.5, -0.3));
  const BuiltChain built = branching_chain(world_R_root);
  EXPECT_EQ(dof(built.chain), 4);
  expect_well_formed(built.chain);
  const auto frames = joint_frames(built.chain, VectorXd::Zero(4));
  const Pose root{world_R_root, Vec3::Zero()};
  const Pose b = root * built.geometries[0].home, c = b * built.geometries[1].home, d = root * built.geometries[2].home;
  for (const auto& [sensor, expected] : {std::pair{"b", b}, {"c", c}, {"d", d}}) {
    const Pose found = frame_of(built.chain, frames, sensor);
    EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-8) << sensor;
    EXPECT_LT((found.position - expected.position).norm(), 1e-7) << sensor;
  }
  EXPECT_LT((built.chain.base.rotation - world_R_root).norm(), 1e-15);
  EXPECT_EQ(active_joint_names(built.chain), (std::vector<std::string>{"a-b", "b-c 1", "b-c 2", "b-c 3"}));
}

TEST(SetTool, IsTheTipOrTheOnlyPoint) {
  const auto tool_of = [](const std::vector<PointEstimate>& places) {
    Chain chain = branching_chain(Mat3::Identity()).chain;
    set_tool(chain, places);
    return chain;
  };
  const PointEstimate tip{.name = "tip", .sensor = "c", .xyz = Vec3(0.1, 0.2, 0.3)},
      corner{.name = "corner", .sensor = "b", .xyz = Vec3(1.0, 0.0, 0.0)};
  EXPECT_EQ(tool_of({corner, tip}).tool.xyz, tip.xyz);
  EXPECT_EQ(tool_of({corner, tip}).joints[static_cast<std::size_t>(tool_of({corner, tip}).tip)].name, "c");
  EXPECT_EQ(tool_of({corner}).tool.xyz, corner.xyz);
  EXPECT_EQ(tool_of({corner, corner}).tip, -1) << "two points, none of them called tip or tool";
  EXPECT_EQ(tool_of({}).tip, -1);
  EXPECT_EQ(tool_of({{.name = "tip", .sensor = "a", .xyz = tip.xyz}}).tip, -1) << "the root is no frame of the chain";
}

TEST(JointEstimateOf, TakesGeometryAndPrecisionOver) {
  Rng rng(7);
  GeometryEstimate hinge{random_geometry(rng), {}};
  hinge.precision.sd.along_axis = 0.3;
  hinge.precision.unobservable_in_parent = {Vec3::UnitX()};
  const JointEstimate joint = joint_estimate("a", "b", hinge);
  EXPECT_EQ(joint_name(joint), "a-b");
  EXPECT_EQ(joint.axis_in_child, hinge.geometry.axis_in_child);
  EXPECT_EQ(joint.point_in_parent, hinge.geometry.point_in_parent);
  EXPECT_EQ(joint.sd.along_axis, 0.3);
  EXPECT_EQ(joint.unobservable_in_parent.size(), 1U);
  EXPECT_TRUE(joint.unobservable_in_child.empty());
}

}  // namespace
}  // namespace kinfer
