// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/mjcf_patch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/geometry/random.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/mjcf_samples.hpp"

namespace kinfer {
namespace {

Chain chain_of(const std::string& text, const ChainEnds& ends) {
  auto chain = parse_mjcf(text, "in.xml", ends);
  EXPECT_TRUE(chain.has_value()) << chain.error().what;
  return chain.value_or(Chain{});
}

PatchedText patched(const std::string& text, const ChainEnds& ends, const Chain& corrected,
                    EncoderOffsets offsets = EncoderOffsets::folded) {
  const auto origins = calibrated_origins(chain_of(text, ends), corrected, offsets);
  EXPECT_TRUE(origins.has_value()) << origins.error().what;
  auto result = patch_mjcf(text, "in.xml", ends, *origins);
  EXPECT_TRUE(result.has_value()) << result.error().what;
  return result.value_or(PatchedText{});
}

UrdfLink& link_of(Chain& chain, const std::string& joint) {
  for (Joint& candidate : chain.joints)
    if (candidate.name == joint) return std::get<UrdfLink>(candidate.link);
  ADD_FAILURE() << joint;
  return std::get<UrdfLink>(chain.joints.front().link);
}

Chain with_every_joint_moved(Chain chain, Rng rng) {
  for (Joint& joint : chain.joints) {
    if (!has_position(joint.type)) continue;
    auto& origin = std::get<UrdfLink>(joint.link).origin;
    origin.xyz += 1e-3 * normal_vector(rng);
    origin.small_rotation = 3e-3 * normal_vector(rng);
  }
  return with_small_rotations_folded(chain);
}

/// The text with the values of what may change cut out of it.
std::string without_places(std::string text) {
  for (const char* key : {"pos", "quat", "euler", "axisangle", "xyaxes", "zaxis", "axis"})
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
      const std::size_t open = text.find_first_of("'\"<>", at), close = text.find(text[open], open + 1);
      if (text[open] != '<' && text[open] != '>') text.erase(open + 1, close - open - 1);
    }
  return text;
}

const ChainEnds to_tcp{.base_link = "world", .tip_link = "tcp"};

TEST(MjcfPatch, OnlyBodiesOfCalibratedJointsChange) {
  const std::string text = test::awkward_mjcf();
  Chain corrected = chain_of(text, to_tcp);
  UrdfLink& slide = link_of(corrected, "elbow");  // its point is 0.01 0 0.02 in the body
  slide.origin = Frame::from_pose(Pose{Mat3::Identity(), Vec3(0.001, 0, 0)} * slide.origin.pose());
  const PatchedText result = patched(text, to_tcp, corrected);
  const std::size_t at = text.find("+.3 0 0"), rest = text.size() - at - 7;
  EXPECT_EQ(result.text.substr(0, at), text.substr(0, at));
  EXPECT_EQ(result.text.substr(result.text.size() - rest), text.substr(text.size() - rest));
  EXPECT_NEAR(std::stod(result.text.substr(at)), 0.301, 1e-15);
  ASSERT_EQ(result.changes.size(), 1U);
  EXPECT_EQ(result.changes[0].joint, "elbow");
  EXPECT_EQ(result.changes[0].line, 21);
  EXPECT_NEAR(result.changes[0].translation.x(), 1e-3, 1e-15);
}

TEST(MjcfPatch, NothingCalibratedNothingChanged) {
  for (const std::string& text : {test::awkward_mjcf(), test::framed_mjcf()}) {
    const ChainEnds ends{.base_link = "world", .tip_link = text == test::framed_mjcf() ? "s" : "tcp"};
    const PatchedText result = patched(text, ends, chain_of(text, ends));
    EXPECT_EQ(result.text, text);
    EXPECT_TRUE(result.changes.empty());
  }
}

TEST(MjcfPatch, EveryOtherByteStays) {
  const std::string text = test::awkward_mjcf();
  const Chain in_file = chain_of(text, to_tcp);
  std::string result = patched(text, to_tcp, with_every_joint_moved(in_file, Rng(3))).text;
  EXPECT_NE(result, text);
  const std::pair<const char*, const char*> additions[] = {
      {"<body childclass=\"wrist\" pos=\"\" quat=\"\">", "<body childclass=\"wrist\">"},  // it had no place
      {"<body name=\"twist\" xyaxes=\"\" pos=\"\">", "<body name=\"twist\" xyaxes=\"\">"},
      {"<body name=\"hand\" quat=\"\" pos", "<body name=\"hand\" zaxis=\"\" pos"},  // a zaxis cannot hold all turns
      {"ref=\"15\" range=\"-170 190\" limited=\"true\" pos=\"\"/>", "ref=\"15\" range=\"-170 190\" limited=\"true\"/>"},
      {"class=\"tool\" pos=\"\" axis=\"\"/>", "class=\"tool\"/>"}};  // by default until now
  std::string rest = without_places(result);
  for (const auto& [now, then] : additions) {
    const std::size_t at = rest.find(now);
    ASSERT_NE(at, std::string::npos) << now << "\n" << rest;
    rest.replace(at, std::string(now).size(), then);
  }
  EXPECT_EQ(rest, without_places(text));
}

TEST(MjcfPatch, OrientationsKeepTheirAttributeAndItsUnit) {
  const auto body = [](const char* orientation) {
    return fmt::format(
        "<mujoco><compiler eulerseq='ZYX'/><worldbody><body name='a' {}><joint name='j'/></body>"
        "</worldbody></mujoco>",
        orientation);
  };
  const ChainEnds ends{.base_link = "world", .tip_link = "a"};
  struct Case {
    const char* before;
    MjcfOrientation kind;
    std::vector<double> after;
  };
  const double sine = std::sin(degree), half = std::sin(degree / 2), cosine = std::cos(degree);
  const Case cases[] = {{"euler='90 0 0'", MjcfOrientation::euler, {91, 0, 0}},
                        {"axisangle='0 0 -2 30'", MjcfOrientation::axisangle, {0, 0, -1, 29}},
                        {"quat='-1 0 0 0'", MjcfOrientation::quat, {-std::cos(degree / 2), 0, 0, -half}},
                        {"xyaxes='1 0 0 0 1 0'", MjcfOrientation::xyaxes, {cosine, sine, 0, -sine, cosine, 0}},
                        {"zaxis='0 0 1'", MjcfOrientation::quat, {std::cos(degree / 2), 0, 0, half}},
                        {"", MjcfOrientation::quat, {std::cos(degree / 2), 0, 0, half}}};
  for (const auto& [before, kind, after] : cases) {
    const std::string text = body(before);
    Chain corrected = chain_of(text, ends);
    UrdfLink& link = link_of(corrected, "j");
    link.origin = Frame::from_pose(Pose{rot_z(degree), Vec3::Zero()} * link.origin.pose());
    const auto tree = parse_mjcf_tree(patched(text, ends, corrected).text, "out.xml");
    ASSERT_TRUE(tree.has_value()) << tree.error().what;
    EXPECT_EQ(tree->bodies[0].orientation, kind) << before;
    ASSERT_EQ(tree->bodies[0].orientation_numbers.size(), after.size()) << before;
    for (std::size_t k = 0; k < after.size(); ++k)
      EXPECT_NEAR(tree->bodies[0].orientation_numbers[k], after[k], 1e-13) << before;
  }
}

TEST(MjcfPatch, ToolPosesAreThoseOfTheCalibratedChain) {
  const std::pair<std::string, ChainEnds> cases[] = {
      {test::awkward_mjcf(), to_tcp},
      {test::awkward_mjcf(), {.base_link = "shoulder", .tip_link = "part"}},
      {test::awkward_mjcf(), {.base_link = "world", .tip_link = "side"}},
      {test::framed_mjcf(), {.base_link = "world", .tip_link = "s"}},
      {test::framed_mjcf(), {.base_link = "a", .tip_link = "b"}}};
  for (const auto& [text, ends] : cases) {
    const Chain corrected = with_every_joint_moved(chain_of(text, ends), Rng(7));
    const Chain written = chain_of(patched(text, ends, corrected).text, ends);
    for (std::uint64_t k = 0; k < 200; ++k) {
      const VectorXd q = laws::random_q(corrected, Rng(7).stream(k));
      const Pose expected = forward(corrected, q), found = forward(written, q);
      EXPECT_LT((expected.position - found.position).norm(), 1e-12) << ends.tip_link;
      EXPECT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-12) << ends.tip_link;
    }
  }
}

TEST(MjcfPatch, SeparateOffsetsAreListedAndNotInTheFile) {
  const std::string text = test::awkward_mjcf();
  Chain corrected = chain_of(text, to_tcp);
  UrdfLink& yaw = link_of(corrected, "yaw");
  yaw.origin = Frame::from_pose(yaw.origin.pose() * Pose{exp_so3(0.01 * yaw.axis), Vec3::Zero()});
  const PatchedText separate = patched(text, to_tcp, corrected, EncoderOffsets::separate);
  EXPECT_EQ(separate.text, text) << "the offset alone was wrong";
  ASSERT_EQ(separate.changes.size(), 1U);
  EXPECT_NEAR(separate.changes[0].offset, 0.01, 1e-12);
  EXPECT_NE(patched(text, to_tcp, corrected).text, text);
}

}  // namespace
}  // namespace kinfer
