// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class UnknownRobot : public Program {};

TEST_F(UnknownRobot, JointTypesAndPointsAloneGiveAValidatedChain) {
  ASSERT_EQ(kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --out data --poses 60").code,
            0);
  const Outcome run = kinfer("calibrate --robot unknown:6R --data data/poses.csv --out cal");
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_NE(run.out.find("found without a data sheet"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("J2 and J3 are parallel"), std::string::npos) << run.out;
  const json evidence = json::parse(slurp(in("cal/evidence.json")));
  EXPECT_LT(evidence["after"]["holdout"]["mean"], 8e-5);
  EXPECT_EQ(kinfer("predict --chain cal/chain.toml --joints data/poses.csv -o p.csv").code, 0);
}

TEST_F(UnknownRobot, BadInputGivesOneSentence) {
  write(in("poses.csv"), "q1,q2,x,y,z\n0,0,0,0,0\n");
  for (const char* types : {"unknown:", "unknown:6X", "unknown:2R"}) {
    const Outcome run = kinfer(std::string("calibrate --robot ") + types + " --data poses.csv --out cal");
    EXPECT_EQ(run.code, 2) << types;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(in("cal")));
  }
}

}  // namespace
}  // namespace kinfer::test
