// SPDX-License-Identifier: Apache-2.0
// Non-geometric terms and fixtures survive writing and reading the robot file.
#include <gtest/gtest.h>

#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/random_field.hpp"

namespace kinfer {
namespace {

RobotModel rich_robot() {
  RobotModel robot{.chain = laws::er20()};
  Chain& chain = robot.chain;
  chain.joints[1].torque_compliance = 3e-6;
  chain.joints[3].backlash = 1e-4;
  chain.joints[0].harmonics = {{1.0, 1e-4, -2e-4}, {80.5, 3e-4, 1e-4}};
  chain.expansion = 2e-5;
  chain.reference_temperature = 21.5;
  chain.field = test::random_field(6, 4, Rng(2));
  chain.setup = "first";
  chain.fixtures.anchors = {Vec3(1.8, -0.9, 0.1)};
  chain.fixtures.sockets = {{"a \"deep\" one", Vec3(1, 2, 3)}, {"b", Vec3(0.5, 0, 0)}};
  chain.fixtures.planes = {
      {.name = "table", .rotation = rot_x(0.3), .small_rotation = Vec3(0.1, 0.2, 0), .offset = 0.4}};
  chain.fixtures.socket_distances = {{0, 1, 0.05, 1e-5}};
  chain.mountings = {{.name = "second", .base = chain.base, .tool = chain.tool},
                     {.name = "J4", .base = {}, .tool = chain.tool, .tip = 3}};
  chain.mountings[0].tool.xyz.x() += 0.1;
  robot.instrument = Instrument{.sigma = 1e-5, .sigma_distance = 2e-5, .sigma_contact = 3e-5, .sigma_tilt = 0.01};
  return robot;
}

TEST(RobotTerms, WritingThenReadingGivesEqualValues) {
  const RobotModel robot = rich_robot();
  const auto read =
      parse_robot_toml(format_robot_toml(robot, {{"sin1q1", 1e-5}, {"cos1q1", 1e-5}, {"anchor1_x", 1e-3}}), "x");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  const Chain &a = robot.chain, &b = read->chain;
  const std::vector<double> torques{1, 20, 3, 4, 5, 6}, approach{1, 1, 1, -1, 1, 0};
  Load load;
  load.temperature_rise = 6.0, load.torques = torques, load.approach = approach;
  const VectorXd q = laws::random_q(a, Rng(4));
  EXPECT_LT((forward(a, q, load).position - forward(b, q, load).position).norm(), 1e-12);
  EXPECT_EQ(b.setup, "first");
  EXPECT_EQ(b.reference_temperature, 21.5);
  EXPECT_EQ(b.fixtures.anchors, a.fixtures.anchors);
  EXPECT_EQ(b.fixtures.sockets[0].name, "a \"deep\" one");
  EXPECT_LT((b.fixtures.sockets[0].xyz - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((b.fixtures.planes[0].normal() - a.fixtures.planes[0].normal()).norm(), 1e-12);
  EXPECT_EQ(b.fixtures.planes[0].offset, 0.4);
  EXPECT_EQ(b.fixtures.socket_distances[0].distance, 0.05);
  EXPECT_EQ(b.fixtures.socket_distances[0].sd, 1e-5);
  ASSERT_EQ(b.mountings.size(), 2u);
  EXPECT_TRUE(b.mountings[0].base.has_value());
  EXPECT_FALSE(b.mountings[1].base.has_value());
  EXPECT_EQ(b.mountings[1].tip, 3);
  EXPECT_LT((b.mountings[0].tool.xyz - a.mountings[0].tool.xyz).norm(), 1e-15);
  EXPECT_EQ(*read->instrument->sigma_contact, 3e-5);
  EXPECT_EQ(*read->instrument->sigma_tilt, 0.01);
}

TEST(RobotTerms, TheAccuracyOfAWireCountsWithoutThatOfPoints) {
  const std::string text = format_robot_toml({.chain = laws::scara()});
  const auto stated = [&](const std::string& sigmas) {
    return parse_robot_toml(text + "[instrument]\n" + sigmas, "r.toml").value().instrument;
  };
  const auto wire = stated("sigma_distance = 0.05\n");
  ASSERT_TRUE(wire.has_value());
  EXPECT_NEAR(*wire->sigma_distance, 0.05e-3, 1e-12);
  EXPECT_NEAR(wire->sigma, 0.05e-3, 1e-12);
  EXPECT_NEAR(stated("sigma_distance = 0.05\nsigma_contact = 0.08\n")->sigma, 0.08e-3, 1e-12);
}

TEST(RobotTerms, AnAccuracyOfAnglesAloneIsStated) {
  const std::string text = format_robot_toml({.chain = laws::scara()});
  const auto stated = [](const std::string& with) { return parse_robot_toml(with, "r.toml").value(); };
  for (const std::string key : {"sigma_direction", "sigma_tilt", "sigma_angle"}) {
    const RobotModel robot = stated(text + "[instrument]\n" + key + " = 0.001\n");
    ASSERT_TRUE(robot.instrument.has_value()) << key;
    EXPECT_EQ(robot.instrument->sigma, 0.0) << key << ": the accuracy of points stays unknown";
    EXPECT_EQ(stated(format_robot_toml(robot)).instrument->sigma, 0.0) << key << ": also when it is written";
  }
  EXPECT_FALSE(stated(text + "[instrument]\nppm = 5\n").instrument.has_value());
  EXPECT_GT(stated(text + "[instrument]\nsigma = 0\n").instrument->sigma, 0.0) << "noise-free is known";
}

TEST(RobotTerms, ErrorsNameTheirLine) {
  const std::string text = format_robot_toml({.chain = laws::scara()});
  const auto with = [&](const std::string& more) { return parse_robot_toml(text + more, "r.toml"); };
  EXPECT_NE(with("[[mounting]]\nname = \"x\"\ntip = \"nobody\"\n").error().what.find("nobody"), std::string::npos);
  EXPECT_NE(with("[[plane]]\nname = \"p\"\noffset = 1\n").error().what.find("normal"), std::string::npos);
  EXPECT_NE(with("[[socket_distance]]\nfrom = \"a\"\nto = \"a\"\ndistance = 50\n").error().what.find("two different"),
            std::string::npos);
}

TEST(PoseSetColumns, TipAndDeviationsOfOrientationsAreReadAndWritten) {
  const Chain chain = laws::er20();
  const std::string text =
      "q1,q2,q3,q4,q5,q6,x,y,z,qw,qx,qy,qz,srx[mrad],sry[mrad],srz[mrad],tip\n"
      "0,0,0,0,0,0,1,2,3,1,0,0,0,1,2,3,J4\n"
      "0,0,0,0,0,0.5,1,2,3,1,0,0,0,,,,\n";
  const auto set = parse_pose_set(text, "p.csv", chain);
  ASSERT_TRUE(set.has_value()) << set.error().what;
  EXPECT_LT((*set->orientations[0].sd - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_FALSE(set->orientations[1].sd.has_value());
  EXPECT_EQ(set->tips, (std::vector<std::string>{"J4"}));
  EXPECT_EQ(set->tip, (std::vector<int>{0, -1}));
  const auto again = parse_pose_set(format_pose_set_csv(*set, chain, FileUnits::mm_deg), "p.csv", chain);
  ASSERT_TRUE(again.has_value()) << again.error().what;
  EXPECT_EQ(again->tip, set->tip);
  EXPECT_LT((*again->orientations[0].sd - *set->orientations[0].sd).norm(), 1e-15);
}

}  // namespace
}  // namespace kinfer
