// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/robot_toml.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "kinfer/base/angle.hpp"

namespace kinfer {
namespace {

constexpr const char* two_joint_robot = R"(name = "arm"
convention = "mdh"
units = { length = "mm", angle = "deg" }
base = { xyz = [1000, 0, 0], rpy = [0, 0, 90] }
tool = { xyz = [0, 0, 120.5], rpy = [180, 0, 0] }
anchors = [[1800, -900, 100]]
[[joint]]
name = "shoulder"
type = "revolute"
a = 0
alpha = 0
d = 504.0
theta = 0
limits = [-90, 180]
[[joint]]
type = "prismatic"
a = 166.605
alpha = -90
d = 0
theta = 45
beta = 0.1
gain = 1.01
coupling = { shoulder = 0.5 }
[[target]]
name = "s2"
xyz = [10, 0, 0]
[[mass]]
link = 2
com = [300, 0, 60]
mass = 60.0
[tolerance]
length = 0.25
gain = 1e-3
[instrument]
kind = "position"
sigma = 0.01
ppm = 5
)";

RobotModel robot_of(const std::string& text) {
  const Result<RobotModel> robot = parse_robot_toml(text, "arm.toml");
  EXPECT_TRUE(robot.has_value()) << (robot ? "" : robot.error().what);
  return robot.value_or(RobotModel{});
}

std::string robot_complaint(const std::string& text) {
  const Result<RobotModel> robot = parse_robot_toml(text, "arm.toml");
  return robot ? "(accepted)" : robot.error().what;
}

std::string with(std::string text, const std::string& old_part, const std::string& new_part) {
  const auto at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return text.replace(at, old_part.size(), new_part);
}

TEST(RobotToml, UnitsApplyToEveryLengthAndAngleOfTheFile) {
  const RobotModel robot = robot_of(two_joint_robot);
  const Chain& chain = robot.chain;
  EXPECT_EQ(chain.name, "arm");
  EXPECT_TRUE(chain.base.xyz.isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(chain.base.rotation.isApprox(rot_z(90 * degree)));
  EXPECT_TRUE(chain.tool.xyz.isApprox(Vec3(0, 0, 0.1205)));
  ASSERT_EQ(chain.joints.size(), 2U);
  EXPECT_DOUBLE_EQ(std::get<MdhLink>(chain.joints[0].link).d, 0.504);
  EXPECT_DOUBLE_EQ(chain.joints[0].lower, -90 * degree);
  EXPECT_DOUBLE_EQ(std::get<MdhLink>(chain.joints[1].link).alpha, -90 * degree);
  EXPECT_DOUBLE_EQ(std::get<MdhLink>(chain.joints[1].link).beta, 0.1 * degree);
  EXPECT_DOUBLE_EQ(robot.tolerances.length, 0.25e-3);
  EXPECT_DOUBLE_EQ(robot.tolerances.gain, 1e-3);
  EXPECT_DOUBLE_EQ(robot.tolerances.angle, 0.1 * degree) << "absent: the default";
  ASSERT_TRUE(robot.instrument.has_value());
  EXPECT_DOUBLE_EQ(robot.instrument->sigma, 1e-5);
  EXPECT_DOUBLE_EQ(robot.instrument->ppm, 5.0);
  ASSERT_EQ(robot.chain.fixtures.anchors.size(), 1U);
  EXPECT_TRUE(robot.chain.fixtures.anchors[0].isApprox(Vec3(1.8, -0.9, 0.1)));
  ASSERT_EQ(chain.targets.size(), 1U);
  EXPECT_TRUE(chain.targets[0].xyz.isApprox(Vec3(0.01, 0, 0)));
  ASSERT_EQ(chain.masses.size(), 1U);
  EXPECT_EQ(chain.masses[0].joint, 1);
  EXPECT_TRUE(chain.masses[0].com.isApprox(Vec3(0.3, 0, 0.06)));
}

TEST(RobotToml, JointsHaveTheirNamesTypesGainsAndCouplings) {
  const Chain chain = robot_of(two_joint_robot).chain;
  EXPECT_EQ(chain.joints[0].name, "shoulder");
  EXPECT_EQ(chain.joints[1].name, "J2") << "named by its row";
  EXPECT_EQ(chain.joints[1].type, JointType::prismatic);
  EXPECT_EQ(chain.joints[1].gain, 1.01);
  ASSERT_EQ(chain.joints[1].couplings.size(), 1U);
  EXPECT_EQ(chain.joints[1].couplings[0].joint, 0);
  EXPECT_EQ(chain.joints[1].couplings[0].factor, 0.5);
  EXPECT_EQ(chain.joints[1].parent, 0) << "the joint before it";
}

TEST(RobotToml, AFileWithoutUnitsIsInMetresAndRadians) {
  const Chain chain =
      robot_of("convention = \"dh\"\n[[joint]]\ntype = \"revolute\"\na = 0.5\nalpha = 1.5\nd = 0\ntheta = 0\n").chain;
  EXPECT_EQ(chain.name, "arm") << "named by its file";
  EXPECT_EQ(std::get<DhLink>(chain.joints[0].link).a, 0.5);
  EXPECT_EQ(std::get<DhLink>(chain.joints[0].link).alpha, 1.5);
}

TEST(RobotToml, BadFilesAreRefusedWithOneSentence) {
  struct Case {
    std::string text, sentence;
  };
  const std::string good = two_joint_robot;
  const Case cases[] = {
      {with(good, "gain = 1.01", "gian = 1.01"), "arm.toml:22: joint 2: unknown key \"gian\""},
      {with(good, "anchors =", "anchor ="), "arm.toml:6: unknown key \"anchor\""},
      {with(good, "length = 0.25", "lenght = 0.25"), "arm.toml:32: tolerance: unknown key \"lenght\""},
      {with(good, "alpha = -90\n", ""), "arm.toml:15: joint 2: \"alpha\" is missing, expected a number"},
      {with(good, "type = \"prismatic\"\n", ""), "arm.toml:15: joint 2: \"type\" is missing, expected a text"},
      {with(good, "convention = \"mdh\"\n", ""),
       "arm.toml:1: \"convention\" is missing, expected \"dh\", \"mdh\" or \"urdf\""},
      {with(good, "\"mdh\"", "\"mhd\""),
       "arm.toml:2: \"convention\": expected \"dh\", \"mdh\" or \"urdf\", found \"mhd\""},
      {with(good, "d = 504.0", "d = \"504\""), "arm.toml:12: joint 1: \"d\": expected a number, found a text"},
      {with(good, "d = 504.0", "d = nan"), "arm.toml:12: joint 1: \"d\": expected a finite number"},
      {with(good, "\"prismatic\"", "\"linear\""),
       "arm.toml:16: joint 2: \"type\": expected " + joint_type_names() + ", found \"linear\""},
      {with(good, "\"deg\"", "\"degrees\""),
       "arm.toml:3: units: \"angle\": expected an angle (rad, deg, mrad), found \"degrees\""},
      {with(good, "\"mm\"", "\"deg\""), "arm.toml:3: units: \"length\": expected a length (m, mm, um), found \"deg\""},
      {with(good, "shoulder = 0.5", "elbow = 0.5"),
       "arm.toml:23: coupling: no joint is named \"elbow\" (there are shoulder, J2)"},
      {with(good, "beta = 0.1", "parent = \"elbow\""),
       "arm.toml:21: joint 2: \"parent\": no joint is named \"elbow\" (there are shoulder, J2)"},
      {with(good, "d = 504.0", "d = 504.0\nparent = \"J2\""),
       "arm.toml:13: joint 1: \"parent\": \"J2\" must be a joint above this one, so that there is no loop"},
      {with(good, "\"shoulder\"", "\"J2\""), "arm.toml:15: joint 2: the name \"J2\" is taken by joint 1"},
      {with(good, "[1000, 0, 0]", "[1000, 0]"), "arm.toml:4: base: \"xyz\": expected 3 numbers, found 2"},
      {with(good, "[-90, 180]", "[180, -90]"),
       "arm.toml:14: joint 1: \"limits\": expected [lower, upper] in this order"},
      {with(good, "link = 2", "link = 3"), "arm.toml:28: mass 1: \"link\": expected a whole number from 1 to 2"},
      {with(good, "length = 0.25", "length = 0"), "arm.toml:32: tolerance: \"length\": expected a number above 0"},
      {with(good, "sigma = 0.01", "sigma = -0.01"), "arm.toml:36: instrument: \"sigma\": expected a number from 0"},
      {"convention = \"dh\"\n", "arm.toml:1: the robot has no joints, expected at least one [[joint]]"},
  };
  for (const Case& bad : cases) EXPECT_EQ(robot_complaint(bad.text), bad.sentence) << bad.text;
}

TEST(RobotToml, TextThatIsNotTomlIsRefusedWithItsLine) {
  EXPECT_EQ(robot_complaint("name = \"arm\"\nconvention = = 3\n").rfind("arm.toml:2: not TOML: ", 0), 0U);
}

TEST(RobotToml, AMissingFileAndAFolderAreErrors) {
  EXPECT_EQ(read_robot_toml("no-such-robot.toml").error().what, "no-such-robot.toml: no such file");
  EXPECT_EQ(read_robot_toml(KINFER_SOURCE_DIR).error().what,
            std::string(KINFER_SOURCE_DIR) + ": expected a file, found a folder");
}

TEST(RobotToml, TheReferenceCasesAreRead) {
  const char* cases = std::getenv("KINFER_CASES");
  if (!cases) GTEST_SKIP() << "KINFER_CASES is not set";
  for (const char* name : {"robot6_tracker", "ur_like_metres", "scara_screw", "arm7_outliers"}) {
    const auto robot = read_robot_toml(std::filesystem::path(cases) / "calibrate" / name / "robot.toml");
    ASSERT_TRUE(robot.has_value()) << robot.error().what;
    EXPECT_EQ(robot->chain.name, name);
  }
}

}  // namespace
}  // namespace kinfer
