// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace kinfer {
namespace {

using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Path : public test::Program {
 protected:
  Outcome path(const std::string& more) const {
    return kinfer("path --chain " + source("examples/robot6/robot.toml") + " " + more);
  }
};

TEST_F(Path, ThroughPosturesEndsAtTheLast) {
  const Outcome run = path("--from 0,-90,90,0,45,0 --via 20,-80,80,0,45,0 --to 40,-90,90,0,45,10 -o path.csv --json");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\"usable\":true"));
  EXPECT_THAT(run.err, HasSubstr("3 waypoints, corners are cut by up to"));
  const std::string text = slurp(in("path.csv"));
  EXPECT_THAT(text, StartsWith("t[s],q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],qd1[deg/s]"));
  EXPECT_THAT(text, HasSubstr(",40,-90,90,0,45,10,0,0,0,0,0,0,0,0,0,0,0,0\n"));
  const Outcome stopping = path("--from 0,-90,90,0,45,0 --via 20,-80,80,0,45,0 --to 40,-90,90,0,45,10 --stop");
  EXPECT_EQ(stopping.err.find("corners"), std::string::npos) << stopping.err;
}

TEST_F(Path, AlongToolLines) {
  predict_targets("10,-80,70,20,40,-30\n15,-75,72,20,45,-30\n");
  const Outcome run = path("--targets targets.csv --prefer 10,-80,70,20,40,-30 -o path.csv");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("2 waypoints"));
}

TEST_F(Path, TargetsThatAreNotReachedAreNamedAsByReach) {
  std::string slides = "convention = \"dh\"\nunits = { length = \"m\", angle = \"deg\" }\n";
  for (const int alpha : {90, 90, 0})
    slides += "[[joint]]\ntype = \"prismatic\"\na = 0\nd = 0\nlimits = [-1, 1]\nalpha = " + std::to_string(alpha) +
              "\ntheta = " + std::to_string(alpha) + "\n";
  write(in("slides.toml"), slides);
  write(in("targets.csv"), "x,y,z\n0,0,0\n0,3,0\n0.5,5,0.5\n3,3,3\n");
  const Outcome run = kinfer("path slides.toml --targets targets.csv -o path.csv");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("s, 1 of 4 waypoints"));
  EXPECT_THAT(run.err, HasSubstr("target 2: only with J3 beyond its limits; 2000.0000 mm and 0.0000 deg are left"));
  EXPECT_THAT(run.err, HasSubstr("target 4: only with J1, J2, J3 beyond their limits; 3464.1016 mm"));
  EXPECT_THAT(run.err, HasSubstr("1 of 4 targets are reached"));
  write(in("targets.csv"), "x,y,z\n30,0,0\n31,0,0\n");
  EXPECT_THAT(path("--targets targets.csv -o path.csv").err, HasSubstr("s, 0 of 2 waypoints"));
}

TEST_F(Path, BadInputIsOneSentence) {
  EXPECT_THAT(path("--from 0,0,0,0,0,0").err, HasSubstr("expected either --from and --to, or --targets"));
  EXPECT_THAT(path("--from 0,0 --to 1,1").err, HasSubstr("--from: the robot has 6 joints, found 2 numbers"));
  EXPECT_THAT(path("--from 0,0,0,0,0,0 --to 9,0,0,0,0,0 --velocity 0").err,
              HasSubstr("--velocity: expected limits above 0"));
  EXPECT_THAT(path("--from 0,0,0,0,0,0 --to 9,0,0,0,0,0 --tool-speed 5").err, HasSubstr("--tool-speed has no effect"));
  EXPECT_THAT(path("--from 0,0,0,0,0,0 --to 9,0,0,0,0,0 --velocity 1e-9").err,
              HasSubstr("and at most 2000000 are written; a larger --step, --velocity"));
  EXPECT_THAT(path("--from 0,0,0,0,0,0 --to 9,0,0,0,0,0 --jerk 1e20").err,
              HasSubstr("is not possible for a limit of a motion"));
  EXPECT_EQ(path("--from 0,0,0,0,0,0 --to 9,0,0,0,0,0 --jerk 1e6 -o quick.csv").code, 0);
  write(in("targets.csv"), "x,y,z,pitch[deg]\n1,0,1,10\n1,0,1,\n");
  EXPECT_THAT(path("--targets targets.csv").err, HasSubstr("must all direct the orientation in the same way"));
}

}  // namespace
}  // namespace kinfer
