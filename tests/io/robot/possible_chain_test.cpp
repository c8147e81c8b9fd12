// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model/possible_chain.hpp"

#include <gmock/gmock.h>

#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;

std::string robot_with(const std::string& line) {
  return "convention = \"mdh\"\n[[joint]]\ntype = \"revolute\"\na = 0.5\nalpha = 0\nd = 0\ntheta = 0\n" + line + "\n";
}

TEST(PossibleChain, NumbersThatNoMachineHasAreRefusedWithTheirLine) {
  for (const std::string line : {"gain = 1e300", "compliance = 1e9", "backlash = 1e200", "beta = 1e17",
                                 "harmonics = [[1, 1e300, 0]]", "limits = [0, 1e300]"}) {
    const auto robot = parse_robot_toml(robot_with(line), "robot.toml");
    ASSERT_FALSE(robot) << line;
    EXPECT_THAT(robot.error().what, HasSubstr("robot.toml:"));
    EXPECT_THAT(robot.error().what, HasSubstr("not possible"));
  }
  EXPECT_TRUE(parse_robot_toml(robot_with("gain = -120"), "robot.toml"));
}

TEST(PossibleChain, ARobotThatCannotMoveIsRefused) {
  const auto robot =
      parse_robot_toml("convention = \"urdf\"\n[[joint]]\ntype = \"fixed\"\nxyz = [0, 0, 1]\n", "r.toml");
  ASSERT_FALSE(robot);
  EXPECT_THAT(robot.error().what, HasSubstr("no joint that moves"));
}

TEST(PossibleChain, ALargeLimitOfAUrdfIsNone) {
  const auto chain = parse_urdf(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
      "<child link='b'/><axis xyz='0 0 1'/><limit lower='-1e300' upper='2' effort='1' velocity='1'/></joint></robot>",
      "r.urdf", {});
  ASSERT_TRUE(chain) << chain.error().what;
  EXPECT_EQ(chain->joints[0].lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(chain->joints[0].upper, 2.0);
}

TEST(PossibleChain, AUrdfWithAnAbsurdLengthIsRefused) {
  const auto chain = parse_urdf(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/>"
      "<child link='b'/><origin xyz='1e200 0 0'/><axis xyz='0 0 1'/></joint></robot>",
      "r.urdf", {});
  ASSERT_FALSE(chain);
  EXPECT_THAT(chain.error().what, HasSubstr("joint \"j\""));
}

}  // namespace
}  // namespace kinfer
