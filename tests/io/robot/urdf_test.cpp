// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/urdf/urdf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

constexpr const char* two_joint_arm = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"><visual><geometry><mesh filename="x.dae"/></geometry></visual></link>
  <link name="upper"/>
  <link name="lower"/>
  <link name="hand"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <origin xyz="0 0 0.5" rpy="0 0 0"/> <axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="upper"/> <child link="lower"/>
    <origin xyz="0.2 0 0"/> <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/>
  </joint>
  <joint name="wrist" type="continuous">
    <parent link="lower"/> <child link="hand"/>
    <mimic joint="shoulder" multiplier="-0.5" offset="0.1"/>
  </joint>
</robot>
)";

std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  const auto at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return at == std::string::npos ? text : text.replace(at, old_part.size(), new_part);
}

std::string urdf_complaint(const std::string& text, const ChainEnds& ends = {}) {
  const auto chain = parse_urdf(text, "arm.urdf", ends);
  return chain ? "(accepted)" : chain.error().what;
}

TEST(Urdf, JointsLimitsAxesAndMimicsAreRead) {
  const auto chain = parse_urdf(two_joint_arm, "arm.urdf");
  ASSERT_TRUE(chain.has_value()) << chain.error().what;
  EXPECT_EQ(chain->name, "arm");
  ASSERT_EQ(chain->joints.size(), 3U);
  EXPECT_EQ(active_joint_names(*chain), (std::vector<std::string>{"shoulder", "slide"}));
  EXPECT_EQ(chain->joints[0].lower, -1);
  EXPECT_EQ(chain->joints[1].upper, 0.3);
  EXPECT_EQ(std::get<UrdfLink>(chain->joints[0].link).axis, Vec3::UnitZ()) << "made a unit vector";
  ASSERT_EQ(chain->joints[2].couplings.size(), 1U);
  EXPECT_EQ(chain->joints[2].couplings[0].joint, 0);
  EXPECT_EQ(chain->joints[2].couplings[0].factor, -0.5);
  // By hand: rotate 0.4 about z, shift 0.1 along x after 0.2, rotate -0.5 · 0.4 + 0.1 about x (URDF's default axis).
  const Pose tool = forward(*chain, VectorXd((VectorXd(2) << 0.4, 0.1).finished()));
  EXPECT_TRUE(tool.position.isApprox(rot_z(0.4) * Vec3(0.3, 0, 0) + Vec3(0, 0, 0.5), 1e-14));
  EXPECT_TRUE(tool.rotation.isApprox(rot_z(0.4) * rot_x(-0.1), 1e-14));
}

TEST(Urdf, BaseAndTipLinksSelectThePartOfTheMachine) {
  const auto part = parse_urdf(two_joint_arm, "arm.urdf", {.base_link = "base", .tip_link = "upper"});
  ASSERT_TRUE(part.has_value());
  EXPECT_EQ(part->joints.size(), 1U);
}

TEST(Urdf, BadFilesAreRefusedWithOneSentence) {
  const std::string good = two_joint_arm;
  struct Case {
    std::string text, sentence;
  };
  const Case cases[] = {
      {replaced(good, "</robot>", ""), "arm.urdf:2: malformed XML (an element does not end)"},
      {replaced(good, "</joint>", ""), "arm.urdf:7: malformed XML (mismatched element)"},
      {"just text", "arm.urdf:1: malformed XML (parsing text)"},
      {"<model/>", "arm.urdf:1: expected <robot> as the outermost element, found <model>"},
      {"<robot name=\"a\"/>", "arm.urdf:1: the robot has no links, expected at least two <link>"},
      {"<robot name=\"a\"><link name=\"b\"/></robot>",
       "arm.urdf:1: the robot has no joints, expected at least one <joint>"},
      {replaced(good, "<link name=\"hand\"/>", "<link name=\"upper\"/>"), "arm.urdf:6: link \"upper\" appears twice"},
      {replaced(good, "<link name=\"hand\"/>", ""),
       "arm.urdf:17: joint \"wrist\": its child link \"hand\" does not exist"},
      {replaced(good, "<child link=\"hand\"/>", ""), "arm.urdf:17: joint \"wrist\" has no <child link=\"...\">"},
      {replaced(good, "name=\"wrist\"", "name=\"slide\""), "arm.urdf:17: joint \"slide\" appears twice"},
      {replaced(good, "<child link=\"hand\"/>", "<child link=\"upper\"/>"),
       "arm.urdf:17: link \"upper\" is the child of joint \"shoulder\" and of joint \"wrist\": loops cannot be read"},
      {replaced(good, "<parent link=\"base\"/>", "<parent link=\"hand\"/>"),
       "arm.urdf:7: joint \"shoulder\" is part of a loop: loops cannot be read"},
      {replaced(good, "<child link=\"hand\"/>", "<child link=\"base\"/>"),
       "arm.urdf:7: joint \"shoulder\" is part of a loop: loops cannot be read"},
      {replaced(good, "<link name=\"hand\"/>", "<link name=\"hand\"/><link name=\"spare\"/>"),
       "arm.urdf:2: links \"base\" and \"spare\" have no parent, expected one root"},
      {replaced(good, "<mimic joint=\"shoulder\"", "<mimic joint=\"neck\""),
       "arm.urdf: joint \"wrist\" mimics joint \"neck\", which does not exist"},
      {replaced(good, "<mimic joint=\"shoulder\"", "<mimic joint=\"wrist\""),
       "arm.urdf: joint \"wrist\" mimics itself"},
      {replaced(good, "xyz=\"1 0 0\"", "xyz=\"0 0 0\""), "arm.urdf: joint \"slide\" has an axis of zeros"},
      {replaced(good, "type=\"continuous\"", "type=\"floating\""),
       "arm.urdf: joint \"wrist\": expected revolute, continuous, prismatic or fixed"},
  };
  for (const Case& bad : cases) EXPECT_EQ(urdf_complaint(bad.text), bad.sentence) << bad.text;
  EXPECT_EQ(urdf_complaint(good, {.base_link = "bass", .tip_link = ""}),
            "arm.urdf: the base link \"bass\" does not exist");
  EXPECT_EQ(urdf_complaint(good, {.base_link = "", .tip_link = "tip"}),
            "arm.urdf: the tip link \"tip\" does not exist");
  EXPECT_EQ(urdf_complaint(good, {.base_link = "lower", .tip_link = "upper"}),
            "arm.urdf: the tip link \"upper\" is not below the base link \"lower\"");
  EXPECT_EQ(urdf_complaint(good, {.base_link = "hand", .tip_link = "hand"}),
            "arm.urdf: base link and tip link are the same, expected joints between them");
}

TEST(Urdf, ParserErrorsAreReturnedAndNotPrinted) {
  testing::internal::CaptureStderr();
  const std::string no_limits =
      replaced(two_joint_arm, "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>", "");
  const std::string sentence = urdf_complaint(no_limits);
  const std::string bad_number = urdf_complaint(replaced(two_joint_arm, "0 0 0.5", "0 0 half"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(sentence.rfind("arm.urdf: not a valid URDF: ", 0), 0U) << sentence;
  EXPECT_NE(sentence.find("shoulder"), std::string::npos) << sentence;
  EXPECT_EQ(bad_number.rfind("arm.urdf: not a valid URDF: ", 0), 0U) << bad_number;
}

// urdfdom prints some errors with the file's text as a format: "%n" ended the process.
TEST(Urdf, TextOfTheFileIsNeverAFormat) {
  for (const char* number : {"0 0 0.5%s%n-17", "0 0 %n%n%n%n", "%1000000000d 0 0", "0 %% 0"}) {
    const std::string sentence = urdf_complaint(replaced(two_joint_arm, "0 0 0.5", number));
    EXPECT_EQ(sentence.rfind("arm.urdf: not a valid URDF: ", 0), 0U) << sentence;
    EXPECT_NE(sentence.find('%'), std::string::npos) << sentence;
  }
  const std::string named = replaced(two_joint_arm, "\"slide\"", "\"100%s%n\"");
  const auto chain = parse_urdf(named, "arm.urdf", {});
  ASSERT_TRUE(chain) << "not read";
  EXPECT_EQ(active_joint_names(*chain).back(), "100%s%n");
}

/// The joint positions of `from` for a chain that has the same joints in another order.
VectorXd reordered(const Chain& to, const Chain& from, const VectorXd& q) {
  const auto from_names = active_joint_names(from), to_names = active_joint_names(to);
  VectorXd result(to_names.size());
  for (std::size_t i = 0; i < to_names.size(); ++i)
    result[i] = q[std::find(from_names.begin(), from_names.end(), to_names[i]) - from_names.begin()];
  return result;
}

class UrdfRoundTrip : public testing::TestWithParam<Chain> {};

TEST_P(UrdfRoundTrip, PredictsTheSamePoses) {
  Chain chain = GetParam();
  for (Joint& joint : chain.joints) joint.compliance = 0.0;  // URDF links are rigid
  const std::string text = format_urdf(chain);
  const auto read = parse_urdf(text, "chain.urdf", {.base_link = "", .tip_link = "tool"});
  ASSERT_TRUE(read.has_value()) << read.error().what << "\n" << text;
  for (int i = 0; i < 20; ++i) {
    const VectorXd q = laws::random_q(chain, Rng(7).stream(i));
    const Pose expected = forward(chain, q), found = forward(*read, reordered(*read, chain, q));
    EXPECT_LT((expected.position - found.position).norm(), 1e-9);
    EXPECT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_P(UrdfRoundTrip, KeepsToolAndTargetsWithoutNamedEnds) {
  Chain chain = GetParam();
  for (Joint& joint : chain.joints) joint.compliance = 0.0;
  chain.targets = {
      {"s2", Vec3(0.5, 0, 0)}, {"tool", Vec3::UnitY()}, {"link_J1", Vec3::UnitZ()}, {"a\x01", -Vec3::UnitX()}};
  const auto read = parse_urdf(format_urdf(chain), "chain.urdf");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  const VectorXd q = laws::random_q(chain, Rng(3));
  const Pose expected = forward(chain, q), found = forward(*read, reordered(*read, chain, q));
  EXPECT_LT((expected.position - found.position).norm(), 1e-9);
  EXPECT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9);
  ASSERT_EQ(read->targets.size(), chain.targets.size());
  for (std::size_t i = 0; i < chain.targets.size(); ++i) {
    EXPECT_EQ(read->targets[i].name, chain.targets[i].name);
    EXPECT_LT((read->targets[i].xyz - chain.targets[i].xyz).norm(), 1e-12);
  }
}

TEST_P(UrdfRoundTrip, KeepsLimitsAndNamesOfTheJoints) {
  const auto read = parse_urdf(format_urdf(GetParam()), "chain.urdf", {.base_link = "", .tip_link = "tool"});
  ASSERT_TRUE(read.has_value()) << read.error().what;
  std::map<std::string, const Joint*> original;
  for (const Joint& joint : GetParam().joints) original[joint.name] = &joint;
  for (const int j : active_joints(*read)) {
    const Joint& joint = read->joints[j];
    ASSERT_EQ(original.count(joint.name), 1U) << joint.name;
    EXPECT_EQ(joint.lower, original[joint.name]->lower);
    EXPECT_EQ(joint.upper, original[joint.name]->upper);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, UrdfRoundTrip, testing::ValuesIn(laws::examples_with_joints()),
                         [](const auto& chain) { return laws::test_name(chain.param); });

TEST(Urdf, TargetsAreLinksOnTheTool) {
  Chain chain = laws::er20();
  chain.targets = {{"s2", Vec3(0.01, 0.02, 0.03)}};
  const auto read = parse_urdf(format_urdf(chain), "chain.urdf", {.base_link = "", .tip_link = "s2"});
  ASSERT_TRUE(read.has_value()) << read.error().what;
  const VectorXd q = laws::random_q(chain, Rng(1));
  EXPECT_LT((forward(*read, q).position - forward(chain, q) * chain.targets[0].xyz).norm(), 1e-9);
}

TEST(Urdf, TheToolIsTheTipOnAShortArmAndAfterASecondRoundTrip) {
  Chain chain = laws::two_arms();
  chain.tip = 5;
  chain.joints[2].couplings.clear();
  chain.targets = {{"s2", Vec3(0.01, 0.02, 0.03)}};
  const auto once = parse_urdf(format_urdf(chain), "chain.urdf");
  ASSERT_TRUE(once.has_value()) << once.error().what;
  EXPECT_EQ(active_joint_names(*once), (std::vector<std::string>{"J1", "J5", "J6"}));
  const auto twice = parse_urdf(format_urdf(*once), "chain.urdf");
  ASSERT_TRUE(twice.has_value()) << twice.error().what;
  ASSERT_EQ(twice->targets.size(), 1U);
  const VectorXd q = Vec3(0.3, -0.4, 0.5);
  EXPECT_LT((forward(*once, q).position - forward(*twice, q).position).norm(), 1e-9);
}

TEST(Urdf, AToolOnFixedJointsOfTheBaseStaysWhereItIs) {
  const Chain chain = laws::with_tool_on_the_base(laws::two_arms());
  const auto read = parse_urdf(format_urdf(chain), "chain.urdf");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  ASSERT_EQ(active_joint_names(*read), active_joint_names(chain));
  const VectorXd q = laws::random_q(chain, Rng(1));
  EXPECT_LT((forward(*read, q).position - forward(chain, q).position).norm(), 1e-9);
  EXPECT_LT(angle_between(forward(*read, q).rotation, forward(chain, q).rotation), 1e-7);
}

TEST(Urdf, WhatIsAttachedToAWrittenToolIsTheTip) {
  Chain chain = laws::er20();
  chain.targets = {{"s2", Vec3(0.01, 0.02, 0.03)}};
  const std::string text = replaced(format_urdf(chain), "</robot>",
                                    "<link name=\"gripper\"/><joint name=\"mount\" type=\"fixed\"><parent link=\"s2\"/>"
                                    "<child link=\"gripper\"/></joint></robot>");
  const auto chain_with_gripper = parse_urdf(text, "chain.urdf");
  ASSERT_TRUE(chain_with_gripper.has_value()) << chain_with_gripper.error().what;
  EXPECT_EQ(chain_with_gripper->joints.back().name, "mount");
  EXPECT_TRUE(chain_with_gripper->targets.empty());
}

TEST(Urdf, AToolOfAnotherProgramIsALinkLikeOthers) {
  const std::string tool =
      "<link name=\"tool\"/><link name=\"tcp\"/>"
      "<joint name=\"flange_to_tool\" type=\"fixed\"><parent link=\"hand\"/><child link=\"tool\"/></joint>"
      "<joint name=\"tool_to_tcp\" type=\"fixed\"><parent link=\"tool\"/><child link=\"tcp\"/>"
      "<origin xyz=\"0 0 0.1\"/></joint></robot>";
  const auto chain = parse_urdf(replaced(two_joint_arm, "</robot>", tool), "arm.urdf");
  ASSERT_TRUE(chain.has_value()) << chain.error().what;
  EXPECT_EQ(chain->joints.back().name, "tool_to_tcp");
  EXPECT_TRUE(chain->targets.empty());
}

TEST(Urdf, NamesThatCollideOrNeedEscapesDoNotBreakTheFile) {
  Chain chain = laws::er20();
  chain.name = "a <strange> \"name\" & more";
  chain.joints[0].name = "world_to_base";
  chain.joints[1].name = "5 < 6 & \"so\"";
  chain.targets = {{"tool", Vec3::UnitX()}, {"world", Vec3::UnitY()}};
  const auto read = parse_urdf(format_urdf(chain), "chain.urdf", {.base_link = "", .tip_link = "tool"});
  ASSERT_TRUE(read.has_value()) << read.error().what << format_urdf(chain);
  EXPECT_EQ(read->name, chain.name);
  EXPECT_EQ(active_joint_names(*read), active_joint_names(chain));
}

TEST(Urdf, ThePandaIsRead) {
  const char* data = std::getenv("KINFER_DATA");
  if (!data) GTEST_SKIP() << "KINFER_DATA is not set";
  const auto chain = read_urdf(std::filesystem::path(data) / "mukca/urdf/panda.urdf",
                               {.base_link = "panda_link0", .tip_link = "panda_link8"});
  ASSERT_TRUE(chain.has_value()) << chain.error().what;
  ASSERT_EQ(dof(*chain), 7);
  // Franka's published reach: upright at q = 0, the flange is 0.088 m ahead and 0.333 + 0.316 + 0.384 - 0.107 m above.
  const Pose flange = forward(*chain, VectorXd(VectorXd::Zero(7)));
  EXPECT_TRUE(flange.position.isApprox(Vec3(0.088, 0, 0.926), 1e-12));
  EXPECT_TRUE(read_urdf(std::filesystem::path(data) / "mukca/urdf/panda.urdf").has_value()) << "the tip is found";
}

}  // namespace
}  // namespace kinfer
