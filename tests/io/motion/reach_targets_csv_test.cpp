// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/motion/reach_targets_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;

ReachTargets parse(const std::string& text) {
  return parse_reach_targets(text, "targets.csv", laws::er20(), {}).value();
}
std::string refusal(const std::string& text) {
  const auto read = parse_reach_targets(text, "targets.csv", laws::er20(), {});
  return read ? "" : read.error().what;
}

TEST(ReachTargetsCsv, EachRowDirectsAsMuchAsItSays) {
  const ReachTargets read =
      parse("x[mm],y[mm],z[mm],axis_i,axis_j,axis_k,pitch[deg]\n1000,0,500,0,0,-1,\n1000,0,500,,,,30\n900,0,400,,,,\n");
  ASSERT_EQ(read.targets.size(), 3U);
  EXPECT_EQ(read.targets[0].position, Vec3(1.0, 0.0, 0.5));
  EXPECT_EQ(std::get<AxisGoal>(read.targets[0].orientation).direction, Vec3(0, 0, -1));
  EXPECT_NEAR(std::get<PitchGoal>(read.targets[1].orientation).angle, 0.5235987755982988, 1e-15);
  EXPECT_TRUE(std::holds_alternative<FreeOrientation>(read.targets[2].orientation));
  EXPECT_EQ(read.preferred.size(), 0);
}

TEST(ReachTargetsCsv, OrientationsAndPreferredPosturesAreRead) {
  const ReachTargets read =
      parse("x[m],y[m],z[m],qw,qx,qy,qz,q1[deg],q2,q3,q4,q5,q6\n1,0,0.5,0,1,0,0,90,0,0,0,0,0.5\n");
  EXPECT_EQ(std::get<FullGoal>(read.targets[0].orientation).rotation, Mat3(Vec3(1, -1, -1).asDiagonal()));
  EXPECT_NEAR(read.preferred(0, 0), 1.5707963267948966, 1e-15);
  EXPECT_EQ(read.preferred(5, 0), 0.5);
}

TEST(ReachTargetsCsv, WrongRowsAreNamed) {
  EXPECT_THAT(refusal("x,y\n1,2\n"), HasSubstr("column z is missing"));
  EXPECT_THAT(refusal("x,y,z,axis_i,axis_j,axis_k\n1,0,0,0,0,2\n"), HasSubstr("expected a length of 1, found 2"));
  EXPECT_THAT(refusal("x,y,z,axis_i,axis_j\n1,0,0,0,0\n"), HasSubstr("axis_k"));
  EXPECT_THAT(refusal("x,y,z,pitch[deg]\n1,0,0,120\n"), HasSubstr("-90 to 90"));
  EXPECT_THAT(refusal("x,y,z,axis_i,axis_j,axis_k,pitch[deg]\n1,0,0,0,0,1,90\n"), HasSubstr("found two"));
}

TEST(PosturesCsv, HasOneRowPerPosture) {
  ReachSolution reached{.status = ReachStatus::reached, .postures = {{Eigen::Vector2d(1.0, 0.5), 0.0}}};
  reached.postures.push_back({Eigen::Vector2d(-1.0, 0.25), 2.0});
  const ReachSolution far{.postures = {{Eigen::Vector2d(0.0, 0.0), 0.0}}, .position_error = 0.1};
  EXPECT_EQ(format_postures_csv({reached, far}, {{"q1", 1.0}, {"q2[mm]", 1e-3}}),
            "target,posture,status,q1,q2[mm],position_error[mm],angle_error[deg]\n"
            "1,1,reached,1,500,0,0\n1,2,reached,-1,250,0,0\n2,1,out_of_reach,0,0,100,0\n");
}

}  // namespace
}  // namespace kinfer
