// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/mjcf/mjcf_tree.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/mjcf_samples.hpp"

namespace kinfer {
namespace {

std::string world(const std::string& inside, const std::string& before = "", const std::string& after = "") {
  return "<mujoco>" + before + "<worldbody>" + inside + "</worldbody>" + after + "</mujoco>";
}

std::string complaint(const std::string& text, const ChainEnds& ends = {}) {
  const auto chain = parse_mjcf(text, "in.xml", ends);
  return chain ? "(accepted)" : chain.error().what;
}

Chain accepted(const std::string& text, const ChainEnds& ends = {}) {
  auto chain = parse_mjcf(text, "in.xml", ends);
  EXPECT_TRUE(chain.has_value()) << chain.error().what;
  return chain.value_or(Chain{});
}

/// Two joints in a row.
const std::string two =
    "<body name='a'><joint name='j1'/><body name='b' pos='1 0 0'><joint name='j2' type='slide'/></body></body>";

TEST(MjcfRead, LimitsReferencesAndTypesAreThoseOfTheFile) {
  const Chain chain =
      accepted(world("<body name='a'><joint name='j1' range='-90 45' ref='10'/><body name='b'>"
                     "<joint name='j2' type='slide' range='-0.1 0.2' ref='0.05' limited='true' axis='2 0 0'/>"
                     "<body name='c'><joint name='j3' range='-1 1' limited='false'/></body></body></body>"));
  ASSERT_EQ(chain.joints.size(), 3U);
  EXPECT_NEAR(chain.joints[0].lower, -90 * degree, 1e-15);
  EXPECT_NEAR(chain.joints[0].upper, 45 * degree, 1e-15);
  EXPECT_EQ(chain.joints[1].type, JointType::prismatic);
  EXPECT_EQ(chain.joints[1].lower, -0.1);
  EXPECT_TRUE(std::isinf(chain.joints[2].lower));
  const Pose at_references = forward(chain, Vec3(10 * degree, 0.05, 0.0));
  EXPECT_LT(at_references.position.norm(), 1e-15);
  const Pose moved = forward(chain, Vec3(100 * degree, 0.15, 0.0));
  EXPECT_LT((moved.position - Vec3(0, 0.1, 0)).norm(), 1e-15) << "0.1 m along x, turned a quarter about z";
}

TEST(MjcfRead, ARangeIsNoLimitWhereAutolimitsIsOff) {
  const std::string joint = "<body><joint name='j' range='-1 1'/></body>";
  EXPECT_TRUE(std::isinf(accepted(world(joint, "<compiler autolimits='false'/>")).joints[0].lower));
  EXPECT_FALSE(std::isinf(accepted(world(joint)).joints[0].lower));
}

TEST(MjcfRead, FramesAreTransformsOfWhatTheyHold) {
  for (const char* tip : {"b", "s"}) {
    const Chain framed = accepted(test::framed_mjcf(), {.base_link = "", .tip_link = tip});
    const Chain plain = accepted(test::unframed_mjcf(), {.base_link = "", .tip_link = tip});
    ASSERT_EQ(active_joint_names(framed), active_joint_names(plain));
    for (std::uint64_t k = 0; k < 20; ++k) {
      const VectorXd q = laws::random_q(plain, Rng(2).stream(k));
      EXPECT_LT((forward(framed, q).position - forward(plain, q).position).norm(), 1e-12);
      EXPECT_LT((forward(framed, q).rotation - forward(plain, q).rotation).norm(), 1e-12);
    }
  }
}

TEST(MjcfRead, EndsAreBodiesOrSites) {
  const std::string text = test::awkward_mjcf();
  EXPECT_EQ(active_joint_names(accepted(text)),
            (std::vector<std::string>{"pan", "lift", "elbow", "roll", "yaw", "slide"}));
  EXPECT_EQ(accepted(text).name, "arm & hand");
  EXPECT_EQ(active_joint_names(accepted(text, {.base_link = "shoulder", .tip_link = "twist"})),
            (std::vector<std::string>{"elbow", "roll", "yaw"}));
  EXPECT_EQ(complaint(text, {.base_link = "", .tip_link = "hnad"}),
            "in.xml: the tip link \"hnad\" does not exist: expected the name of a body or of a site");
  EXPECT_EQ(complaint(text, {.base_link = "tcp", .tip_link = ""}),
            "in.xml: the base link \"tcp\" does not exist: expected the name of a body, or world");
  EXPECT_EQ(complaint(text, {.base_link = "side", .tip_link = "hand"}),
            "in.xml: the tip link \"hand\" is not below the base link \"side\"");
  EXPECT_EQ(complaint(text, {.base_link = "twist", .tip_link = "hand"}),
            "in.xml: joint \"follower\" follows joint \"pan\", which is not below the base link");
  EXPECT_EQ(complaint(text, {.base_link = "hand", .tip_link = "hand"}),
            "in.xml: no joint between the base link and the tip link moves");
}

TEST(MjcfRead, TheToolThatIsWrittenIsTheTip) {
  Chain robot = accepted(test::unframed_mjcf());
  robot.tool.xyz = Vec3(0.03, 0.02, 0.1);
  const Chain back = accepted(format_mjcf(robot));
  const VectorXd q = laws::random_q(robot, Rng(3).stream(1));
  EXPECT_LT((forward(back, q).position - forward(robot, q).position).norm(), 1e-9);
}

TEST(MjcfRead, TheToolThatIsWrittenIsTheTipOnAShortArm) {
  Chain robot = laws::two_arms();
  robot.tip = 5;
  robot.joints[2].couplings.clear();
  const Chain read = accepted(format_mjcf(robot));
  EXPECT_EQ(active_joint_names(read), (std::vector<std::string>{"J1", "J5", "J6"}));
}

TEST(MjcfRead, AToolOnFixedJointsOfTheBaseStaysWhereItIs) {
  const Chain robot = laws::with_tool_on_the_base(laws::two_arms());
  const Chain read = accepted(format_mjcf(robot));
  ASSERT_EQ(active_joint_names(read), active_joint_names(robot));
  const VectorXd q = laws::random_q(robot, Rng(3).stream(1));
  EXPECT_LT((forward(read, q).position - forward(robot, q).position).norm(), 1e-9);
  EXPECT_LT(angle_between(forward(read, q).rotation, forward(robot, q).rotation), 1e-7);
}

// MuJoCo refuses a file in which two sites have the same name.
TEST(MjcfRead, AJointOrTargetNamedToolIsNotTheTool) {
  for (const char* joint : {"tool", "tool_2", "J6"}) {
    Chain robot = laws::er20();
    robot.joints[5].name = joint;
    robot.targets = {{"tool", Vec3(0.5, 0, 0)}, {"J1", Vec3(0, 0.5, 0)}};
    const std::string text = format_mjcf(robot);
    const auto tree = parse_mjcf_tree(text, "chain.mjcf");
    ASSERT_TRUE(tree) << tree.error().what;
    std::set<std::string> names;
    for (const MjcfSite& site : tree->sites) EXPECT_TRUE(names.insert(site.name).second) << site.name;
    EXPECT_EQ(names.size(), 9U) << "six joints, the tool, two targets";
    const Chain read = accepted(text);
    EXPECT_EQ(active_joint_names(read), active_joint_names(robot));
    const VectorXd q = laws::random_q(robot, Rng(4));
    EXPECT_LT((forward(read, q).position - forward(robot, q).position).norm(), 1e-9);
  }
}

TEST(MjcfRead, AFreeThingBesideARobotIsNoPartOfIt) {
  const std::string cup =
      "<body name='cup'><freejoint/><body><joint/><body><joint/><body><joint/></body></body></body></body>";
  EXPECT_EQ(active_joint_names(accepted(world(cup + two))), (std::vector<std::string>{"j1", "j2"}));
  EXPECT_EQ(
      complaint(world("<body name='torso'><joint type='free' name='root'/>" + two + "</body>")),
      "in.xml: line 1: joint \"root\" is a free joint, which a chain cannot hold: expected hinge and slide joints "
      "alone (--base-link \"torso\" begins the chain below it)");
  EXPECT_EQ(accepted(world("<body name='torso'><freejoint/>" + two + "</body>"), {.base_link = "torso", .tip_link = ""})
                .joints.size(),
            2U);
  EXPECT_NE(complaint(world("<body name='a'><joint/><body name='b'><joint type='ball' name='wrist'/></body></body>"))
                .find("joint \"wrist\" is a ball joint"),
            std::string::npos);
}

TEST(MjcfRead, NamelessBodiesAndJointsGetNames) {
  const Chain chain = accepted(world("<body><joint/><joint/><body name='arm'><joint/></body></body>"));
  EXPECT_EQ(active_joint_names(chain), (std::vector<std::string>{"body1_joint", "body1_joint2", "arm_joint"}));
}

TEST(MjcfRead, WhatIsWrongIsOneSentenceWithItsLine) {
  const std::string equality = "<equality><joint joint1='j2' joint2='j1' polycoef='{}'/></equality>";
  const auto tied = [&](const char* polynomial) {
    return world(two, "", fmt::format(fmt::runtime(equality), polynomial));
  };
  const std::pair<std::string, const char*> cases[] = {
      {"<mujoco><worldbody>", "in.xml:1: malformed XML"},
      {"<robot/>", "in.xml:1: expected <mujoco> as the outermost element, found <robot>"},
      {"<mujoco/>", "in.xml: no body below the base link \"world\""},
      {world("<geom/>"), "in.xml: no body below the base link \"world\""},
      {"<mujoco>\n<include file='x.xml'/></mujoco>", "in.xml:2: <include> is not followed: give one complete file"},
      {world("<body><include file='x.xml'/></body>"), "in.xml:1: <include> is not followed"},
      {world("<replicate count='3'>" + two + "</replicate>"), "in.xml:1: <replicate> is not carried out"},
      {world("<attach model='x'/>"), "in.xml:1: <attach> is not carried out"},
      {world(two, "<compiler coordinate='global'/>"), "in.xml:1: coordinate=\"global\" cannot be read"},
      {world(two, "<compiler angle='gon'/>"), "in.xml:1: angle=\"gon\": expected degree or radian"},
      {world(two, "<compiler eulerseq='xyw'/>"), "in.xml:1: eulerseq=\"xyw\": expected three of"},
      {world("<body name='a' pos='0 nan 0'/>"), "in.xml:1: body \"a\": pos=\"0 nan 0\": a number is not finite"},
      {world("<body name='a' pos='0 1e999 0'/>"), "in.xml:1: body \"a\": pos=\"0 1e999 0\": expected 3 numbers"},
      {world("<body name='a' pos='0,5 0 0'/>"), "in.xml:1: body \"a\": pos=\"0,5 0 0\": expected 3 numbers"},
      {world("<body name='a' pos='1 2'/>"), "in.xml:1: body \"a\": pos=\"1 2\": expected 3 numbers"},
      {world("<body name='a' quat='0 0 0 0'/>"), "in.xml:1: body \"a\": quat=\"0 0 0 0\" gives no direction"},
      {world("<body name='a' xyaxes='1 0 0 1 0 0'/>"),
       "in.xml:1: body \"a\": xyaxes=\"1 0 0 1 0 0\" gives no direction"},
      {world("<body name='a' quat='1 0 0 0' euler='0 0 0'/>"), "in.xml:1: body \"a\": more than one orientation"},
      {world("<body name='a' pos='1e9 0 0'><joint/></body>"),
       "in.xml: joint \"a_joint\": origin: 1e+09 m is not possible"},
      {world("<body><joint name='j' axis='0 0 0'/></body>"),
       "in.xml:1: joint \"j\": axis is zeros, expected a direction"},
      {world("<body><joint name='j' type='screw'/></body>"),
       "in.xml:1: joint \"j\": type=\"screw\": expected hinge, slide"},
      {world("<body><joint name='j' range='2 1'/></body>"),
       "in.xml: joint \"j\": limits: expected the lower one first"},
      {world("<body><joint name='j' class='x'/></body>"), "in.xml:1: joint \"j\": default class \"x\" does not exist"},
      {world("<body name='a' childclass='x'/>"), "in.xml:1: body \"a\": default class \"x\" does not exist"},
      {world(two, "<default><default/></default>"), "in.xml:1: a <default> inside another has no class"},
      {world(two + two), "in.xml:1: body \"a\" appears twice"},
      {world("<body><joint name='j'/><joint name='j'/></body>"), "in.xml:1: joint \"j\" appears twice"},
      {world("<body name='world'/>"), "in.xml:1: body \"world\" appears twice"},
      {world("<joint/>"), "in.xml:1: a joint of the world: expected it in a body"},
      {world("<body name='a'/>"), "in.xml: no joint between the base link and the tip link moves"},
      {tied("0 1 0.5"), "in.xml: joint \"j2\" follows joint \"j1\" by a polynomial of degree 2 or more (line 1)"},
      {tied("0 1 0 0 0 0"), "in.xml:1: a <joint>: polycoef=\"0 1 0 0 0 0\": expected 1 to 5 numbers"},
      {world(two, "", "<equality><joint joint1='j1' joint2='j2'/><joint joint1='j2' joint2='j1'/></equality>"),
       "in.xml: joint \"j1\" follows itself by its equalities"},
      {world(two, "", "<equality><joint joint1='j1' joint2='j1'/></equality>"),
       "in.xml: joint \"j1\" follows itself by its equalities"},
      {world(two, "", "<equality><joint joint1='j2' joint2='j1'/>\n<joint joint1='j2'/></equality>"),
       "in.xml: joint \"j2\" is constrained by two equalities, in lines 1 and 2"},
      {world(two, "", "<equality><joint joint1='j3' joint2='j1'/></equality>"),
       "in.xml:1: an equality constrains joint \"j3\", which does not exist"},
      {world("<body><joint/><site name='s' fromto='0 0 0 1 0 0'/></body>"), "(accepted)"}};
  for (const auto& [text, sentence] : cases)
    EXPECT_EQ(complaint(text).rfind(sentence, 0), 0U) << complaint(text) << "\n" << text;
  EXPECT_EQ(complaint(cases[std::size(cases) - 1].first, {.base_link = "", .tip_link = "s"}),
            "in.xml: site \"s\" is placed by fromto: expected pos and an orientation");
}

TEST(MjcfRead, AJointThatIsHeldDoesNotMove) {
  const Chain chain = accepted(world(two, "", "<equality><joint joint1='j2' polycoef='0.25'/></equality>"));
  EXPECT_EQ(dof(chain), 1);
  EXPECT_LT((forward(chain, VectorXd::Zero(1)).position - Vec3(1, 0, 0.25)).norm(), 1e-15);
}

TEST(MjcfRead, HundredsOfBodiesAreReadAndATowerIsRefusedInOneSentence) {
  std::string row, open, close;
  for (int i = 0; i < 300; ++i) row += fmt::format("<body name='b{}' pos='{} 0 0'><joint name='j{}'/></body>", i, i, i);
  EXPECT_EQ(accepted(world(row), {.base_link = "", .tip_link = "b299"}).joints.size(), 1U);
  for (int i = 0; i < 90; ++i) open += "<body pos='0 0 1'><joint/>", close += "</body>";
  EXPECT_EQ(dof(accepted(world(open + close))), 90);
  EXPECT_EQ(complaint(world(open + open + close + close)),
            "in.xml:1: malformed XML (more than 100 elements inside each other)");
}

}  // namespace
}  // namespace kinfer
