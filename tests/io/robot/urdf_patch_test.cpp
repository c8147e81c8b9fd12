// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/urdf_patch.hpp"

#include <gmock/gmock.h>

#include "kinfer/geometry/random.hpp"
#include "kinfer/io/robot/patch/joint_origins_yaml.hpp"
#include "kinfer/io/robot/patch/urdf_joints.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

// Byte order mark, CRLF, single quotes, entities, namespaces, comments and CDATA that look like joints, joints of other
// elements, attributes on lines of their own, joints without an origin or a rotation.
std::string awkward_urdf() {
  return "\xEF\xBB\xBF<?xml version='1.0' encoding='utf-8' ?>\r\n<?xml-model href=\"<joint>\"?>\r\n"
         "<!-- made by hand: <joint name=\"shoulder\"><origin xyz=\"9 9 9\"/></joint> -->\r\n"
         "<robot name='a &amp; b'\r\n   xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\r\n"
         "\t<link name=\"base\"><visual><origin xyz=\"1 2 3\" rpy='0 0 0' /><geometry><mesh "
         "filename='package://x/a&apos;b.dae' scale=\"1e-3 1e-3 1e-3\"/></geometry></visual></link>\r\n"
         "  <link name='upper'/>\n  <link name=\"lower\" ></link >\n<link name=\"hand\"/> <link name=\"side\"/>\r\n"
         "  <transmission name=\"t\"><joint name=\"shoulder\"><origin xyz=\"7 7 7\"/></joint></transmission>\r\n"
         "  <gazebo reference='upper'><![CDATA[ <joint name=\"slide\"><origin xyz=\"8 8 8\"/> ]]></gazebo>\r\n"
         "  <joint name='shoulder' type = \"revolute\" >\r\n"
         "    <!-- <origin xyz=\"6 6 6\"/> -->\r\n"
         "    <origin\r\n      xyz = '0  0 0.5'\r\n      rpy='0 1.5707963267948966 0' />\r\n"
         "    <parent link=\"base\"/> <child link='upper'/> <axis xyz=\"0 0 2\"/>\r\n"
         "    <limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>\r\n  </joint>\r\n"
         "  <joint name=\"slide\" type=\"prismatic\"><parent link=\"upper\"/><child link=\"lower\"/>\n"
         "\t\t<origin xyz=\"2.0e-1 +0 0\"/><axis xyz=\"1 0 0\"/>"
         "<limit effort=\"1\" lower=\"0\" upper=\"0.3\" velocity=\"1\"/></joint>\n"
         "  <joint name=\"wrist\" type=\"continuous\">\n      <parent link='lower' />\n      <child link='hand' />\n"
         "      <mimic joint=\"shoulder\" multiplier=\"-0.5\" offset=\"0.1\"/>\n  </joint>\n"
         "  <joint name=\"branch\" type=\"revolute\"><origin/><parent link=\"upper\"/><child link=\"side\"/>"
         "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>\n"
         "  <a:joint xmlns:a='urn:a' name='b'/>\n</robot>\n<!-- end -->";
}

/// Every joint's frame moved and turned, base and tool too.
Chain disturbed(Chain chain, Rng rng) {
  for (Joint& joint : chain.joints) {
    auto& link = std::get<UrdfLink>(joint.link);
    if (!has_position(joint.type)) continue;
    link.origin.xyz += 1e-3 * normal_vector(rng);
    link.origin.small_rotation = 3e-3 * normal_vector(rng);
  }
  return with_small_rotations_folded(chain);
}

/// The text with the origins of the joints cut down to a mark.
std::string without_origins(const std::string& text) {
  const auto joints = locate_urdf_joints(text, "in.urdf");
  EXPECT_TRUE(joints.has_value());
  std::string rest = text;
  for (auto joint = joints->joints.rbegin(); joint != joints->joints.rend(); ++joint) {
    if (!joint->origin) continue;
    std::vector<XmlAttributePosition> places = joint->origin->attributes;
    for (auto place = places.rbegin(); place != places.rend(); ++place)
      rest.replace(place->begin, place->end - place->begin, "*");
  }
  return rest;
}

PatchedText patched(const std::string& text, const Chain& in_file, const Chain& corrected,
                    EncoderOffsets offsets = EncoderOffsets::folded) {
  const auto origins = calibrated_origins(in_file, corrected, offsets);
  EXPECT_TRUE(origins.has_value()) << origins.error().what;
  auto result = patch_urdf(text, "in.urdf", *origins);
  EXPECT_TRUE(result.has_value()) << result.error().what;
  return result.value_or(PatchedText{});
}

/// The written file has the tool poses of the corrected chain; of joint positions with the offsets added.
void expect_same_tool_poses(const std::string& text, const ChainEnds& ends, EncoderOffsets offsets,
                            std::uint64_t seed) {
  const auto in_file = parse_urdf(text, "in.urdf", ends);
  ASSERT_TRUE(in_file.has_value()) << in_file.error().what;
  const Chain corrected = disturbed(*in_file, Rng(seed));
  const auto origins = calibrated_origins(*in_file, corrected, offsets);
  ASSERT_TRUE(origins.has_value()) << origins.error().what;
  const auto written = parse_urdf(patched(text, *in_file, corrected, offsets).text, "out.urdf", ends);
  ASSERT_TRUE(written.has_value()) << written.error().what;
  const std::vector<int> active = active_joints(corrected);
  for (int i = 0; i < 200; ++i) {
    const VectorXd q = laws::random_q(corrected, Rng(seed).stream(i));
    VectorXd shifted = q;
    for (std::size_t k = 0; k < active.size(); ++k)
      for (const CalibratedOrigin& origin : *origins)
        if (origin.joint == corrected.joints[active[k]].name) shifted[k] += origin.offset;
    const Pose expected = forward(corrected, q), found = forward(*written, shifted);
    EXPECT_LT((expected.position - found.position).norm(), 1e-9);
    EXPECT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(UrdfPatch, OnlyOriginsOfCalibratedJointsChange) {
  const std::string text = awkward_urdf();
  const auto in_file = parse_urdf(text, "in.urdf", {.base_link = "", .tip_link = "hand"});
  ASSERT_TRUE(in_file.has_value()) << in_file.error().what;
  Chain corrected = *in_file;
  std::get<UrdfLink>(corrected.joints[0].link).origin.xyz = {0.001, 0, 0.5};
  std::get<UrdfLink>(corrected.joints[1].link).origin.xyz = {0.25, 0, 0};
  std::string expected = text;
  expected.replace(expected.find("0  0 0.5"), 8, "0.001 0 0.5");
  expected.replace(expected.find("2.0e-1 +0 0"), 11, "0.25 0 0");
  const PatchedText result = patched(text, *in_file, corrected);
  EXPECT_EQ(result.text, expected);
  ASSERT_EQ(result.changes.size(), 2U);
  EXPECT_EQ(result.changes[0].joint, "shoulder");
  EXPECT_EQ(result.changes[0].line, 12);
  EXPECT_NEAR(result.changes[0].translation.x(), 1e-3, 1e-15);
}

TEST(UrdfPatch, WhatIsMissingIsAddedInTheStyleBeside) {
  const std::string text = awkward_urdf();
  const auto in_file = parse_urdf(text, "in.urdf", {.base_link = "", .tip_link = "hand"});
  ASSERT_TRUE(in_file.has_value());
  Chain corrected = *in_file;
  std::get<UrdfLink>(corrected.joints[1].link).origin.rotation = rot_z(0.25);
  std::get<UrdfLink>(corrected.joints[2].link).origin.xyz = {0.5, 0, 0};
  const PatchedText result = patched(text, *in_file, corrected);
  EXPECT_NE(result.text.find("<origin xyz=\"2.0e-1 +0 0\" rpy=\"0 0 0.25\"/><axis"), std::string::npos) << result.text;
  EXPECT_NE(result.text.find("\n      <origin xyz='0.5 0 0' rpy='0 0 0' />\n      <parent link='lower' />"),
            std::string::npos)
      << result.text;
  EXPECT_TRUE(result.changes[1].inserted);
}

TEST(UrdfPatch, ToolPosesAreThoseOfTheCalibratedChain) {
  for (const EncoderOffsets offsets : {EncoderOffsets::folded, EncoderOffsets::separate}) {
    for (const char* tip : {"hand", "side"})
      expect_same_tool_poses(awkward_urdf(), {.base_link = "", .tip_link = tip}, offsets, 3);
    for (Chain chain : laws::examples_with_joints()) {  // serial arms, trees and mimic joints
      for (Joint& joint : chain.joints) joint.compliance = 0.0;
      expect_same_tool_poses(format_urdf(chain), {.base_link = "", .tip_link = "tool"}, offsets, 5);
    }
  }
}

TEST(UrdfPatch, AFileOfSixtyLinksSurvivesByteForByte) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"snake\">\n";
  for (int i = 0; i <= 60; ++i)
    text += fmt::format(
        "  <link name=\"l{}\">\n    <inertial><mass value=\"{}\"/></inertial>\n    <visual><geometry><mesh "
        "filename=\"package://snake/{}.stl\"/></geometry></visual>\n  </link>\n",
        i, i, i);
  for (int i = 0; i < 60; ++i)
    text += fmt::format(
        "  <joint name=\"j{}\" type=\"{}\">\n    <origin rpy=\"{} 0.5 0\" xyz=\"0 0 0.{}\"/>\n    <parent "
        "link=\"l{}\"/>"
        "\n    <child link=\"l{}\"/>\n    <axis xyz=\"0 1 0\"/>\n  </joint>\n",
        i, i % 7 == 3 ? "fixed" : "continuous", i, i + 1, i, i + 1);
  text += "</robot>\n";
  const auto in_file = parse_urdf(text, "in.urdf");
  ASSERT_TRUE(in_file.has_value()) << in_file.error().what;
  const PatchedText result = patched(text, *in_file, disturbed(*in_file, Rng(1)));
  EXPECT_EQ(result.changes.size(), 51U);
  EXPECT_NE(result.text, text);
  EXPECT_EQ(without_origins(result.text), without_origins(text));
  EXPECT_EQ(patched(text, *in_file, *in_file).text, text) << "nothing calibrated, nothing changed";
  expect_same_tool_poses(text, {}, EncoderOffsets::folded, 9);
}

TEST(UrdfPatch, AnotherMachineIsRefused) {
  const auto in_file = parse_urdf(awkward_urdf(), "in.urdf", {.base_link = "", .tip_link = "hand"});
  ASSERT_TRUE(in_file.has_value());
  Chain other = *in_file;
  std::get<UrdfLink>(other.joints[0].link).axis = Vec3::UnitX();
  EXPECT_FALSE(calibrated_origins(*in_file, other, EncoderOffsets::folded).has_value());
  other = *in_file;
  other.joints[1].name = "slider";
  const auto refused = calibrated_origins(*in_file, other, EncoderOffsets::folded);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what,
            "joint 2 of the calibrated chain, \"slider\", is not joint \"slide\" of the robot file");
}

TEST(UrdfPatch, AnOriginThatNoFileMayHoldIsRefused) {
  const auto in_file = parse_urdf(awkward_urdf(), "in.urdf", {.base_link = "", .tip_link = "hand"});
  ASSERT_TRUE(in_file.has_value()) << in_file.error().what;
  Chain corrected = *in_file;
  std::get<UrdfLink>(corrected.joints[0].link).origin.xyz.x() = 3e7;
  const auto refused = calibrated_origins(*in_file, corrected, EncoderOffsets::folded);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().what, testing::HasSubstr("is not possible for a length"));
}

TEST(UrdfPatch, AnglesStayNearTheFilesOwn) {
  const Vec3 like(3.1, 0.1, -3.1), near(-3.13, 0.12, 3.14);  // the same turn of 2 pi apart
  const Vec3 rpy = rpy_near(from_rpy(near), like);
  EXPECT_LT((rpy - like).norm(), 0.1);
  EXPECT_TRUE(from_rpy(rpy).isApprox(from_rpy(near), 1e-14));
  const Vec3 flipped = rpy_near(from_rpy({0.01, 0.02, 0.03}), {3.14, 3.14, 3.14});
  EXPECT_LT((flipped - Vec3(3.14, 3.14, 3.14)).norm(), 0.1);
}

TEST(UrdfPatch, MalformedTextHasNoPositions) {
  for (const char* text : {"<a", "<a>", "<a></b>", "<a b></a>", "<a b=c/>", "<a b=\"c/>", "<!-- ", "</a>"})
    EXPECT_FALSE(xml_positions(text).has_value()) << text;
}

std::string arm_of(const std::vector<std::pair<std::string, std::string>>& joints_and_links) {
  std::string text = "<robot name='arm'><link name='base'/>", parent = "base";
  for (const auto& [joint, link] : joints_and_links) {
    text += fmt::format(
        "<link name='{}'/><joint name='{}' type='continuous'><origin xyz='0 0 0.25'/><parent link='{}'/>"
        "<child link='{}'/></joint>",
        link, joint, parent, link);
    parent = link;
  }
  return text + "</robot>";
}

std::string kinematics_of(const std::string& text) {
  const auto joints = locate_urdf_joints(text, "arm.urdf");
  return joints ? format_kinematics_yaml(*joints).value_or("(none)") : joints.error().what;
}

TEST(JointOriginsYaml, UniversalRobotsAndFrankaLoadIt) {
  const std::string ur = kinematics_of(arm_of({{"shoulder_pan_joint", "shoulder_link"},
                                               {"shoulder_lift_joint", "upper_arm_link"},
                                               {"elbow_joint", "forearm_link"},
                                               {"wrist_1_joint", "wrist_1_link"},
                                               {"wrist_2_joint", "wrist_2_link"},
                                               {"wrist_3_joint", "wrist_3_link"}}));
  EXPECT_NE(ur.find("kinematics:\n  shoulder:\n    x: 0\n    y: 0\n    z: 0.25\n    roll: 0\n    pitch: 0\n    yaw: 0\n"
                    "  upper_arm:\n"),
            std::string::npos)
      << ur;
  EXPECT_NE(ur.find("  hash: "), std::string::npos);
  std::vector<std::pair<std::string, std::string>> franka;
  for (int i = 1; i <= 7; ++i) franka.push_back({fmt::format("fr3_joint{}", i), fmt::format("fr3_link{}", i)});
  franka.push_back({"fr3_finger_joint1", "finger"});  // of the hand, not of the arm
  EXPECT_NE(kinematics_of(arm_of(franka)).find("\njoint7:\n  kinematic:\n    x: 0\n"), std::string::npos);
  EXPECT_EQ(kinematics_of(arm_of({{"joint1", "l"}})), "(none)");
}

TEST(JointOriginsYaml, NamesThatAreNoWordsAreQuoted) {
  const auto joints = locate_urdf_joints(arm_of({{"1: \"a\"", "l"}}), "arm.urdf");
  ASSERT_TRUE(joints.has_value());
  EXPECT_NE(format_joint_origins_yaml(*joints, {}).find("\n  \"1: \\\"a\\\"\":\n    x: 0\n"), std::string::npos);
}

}  // namespace
}  // namespace kinfer
