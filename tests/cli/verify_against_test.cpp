// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class VerifyAgainst : public Program {
 protected:
  void calibrate_robot(const std::string& name, int seed) const {
    ASSERT_EQ(kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --errors errors.toml --out " +
                     name + " --lowest 0 --clearance 350 --seed " + std::to_string(seed))
                  .code,
              0);
    const Outcome run = kinfer("calibrate --robot " + name + "/robot.toml --data " + name + "/poses.csv --out " + name +
                               "/cal --model geometry");
    ASSERT_EQ(run.code, 0) << run.out << run.err;
  }
};

TEST_F(VerifyAgainst, AChangedJointIsNamedAndAnUnchangedRobotIsNot) {
  const std::string units = "units = { length = \"mm\", angle = \"deg\" }\n[errors]\na2 = 0.1\n";
  write(in("errors.toml"), units + "theta3 = 0.05\n");
  calibrate_robot("may", 1);
  calibrate_robot("june", 2);
  write(in("errors.toml"), units + "theta3 = 0.08\n");
  calibrate_robot("july", 3);
  const Outcome same = kinfer("verify --chain may/cal/chain.toml --against june/cal/chain.toml");
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_NE(same.out.find("No change beyond chance"), std::string::npos) << same.out;
  const Outcome knocked = kinfer("verify --chain may/cal/chain.toml --against july/cal/chain.toml --json");
  EXPECT_EQ(knocked.code, 1) << knocked.out << knocked.err;
  const json changes = json::parse(knocked.out);
  EXPECT_EQ(changes["parameters"][0]["name"], "theta3");
  EXPECT_TRUE(changes["parameters"][0]["significant"]);
}

TEST_F(VerifyAgainst, TablesOfACalibrationAreWrittenBesideItsChain) {
  write(in("errors.toml"), "units = { length = \"mm\", angle = \"deg\" }\n[errors]\na2 = 0.1\n");
  calibrate_robot("may", 1);
  for (const char* file :
       {"chain_mdh.csv", "chain_dh.csv", "joint_twists.csv", "encoder_offsets.csv", "covariance.csv", "accuracy.csv"})
    EXPECT_TRUE(fs::exists(in("may/cal") / file)) << file;
  const json iso = json::parse(slurp(in("may/cal/evidence.json")))["iso9283"];
  EXPECT_LT(iso["pose_accuracy_after"]["mean"], iso["pose_accuracy_before"]["mean"]);
  EXPECT_EQ(iso["pose_repeatability"]["n"], 0);
  EXPECT_EQ(slurp(in("may/cal/chain_mdh.csv")).find("joint,type,theta[deg],d[mm],a[mm],alpha[deg],beta[deg],gain\nJ1,"),
            0u);
}

TEST_F(VerifyAgainst, NeitherDataNorALaterChainIsAnError) {
  const Outcome run = kinfer("verify --chain " + source("examples/robot6/robot.toml"));
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("--against"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace kinfer::test
