// SPDX-License-Identifier: Apache-2.0
// simulate-poses --shake: poses with correlated errors of point and orientation, from the command line to the
// calibrated robot.
#include "cli/program.hpp"

namespace kinfer::test {
namespace {

class ShakenPoses : public Program {
 protected:
  std::string simulate(const std::string& more) const {
    return "simulate-poses --robot " + source("examples/robot6/robot.toml") + " --out data --poses 40 --shake 0.006 " +
           more;
  }
};

TEST_F(ShakenPoses, ComeWithTheirSixBySixCovarianceWhichCalibrateUses) {
  ASSERT_EQ(kinfer(simulate("--measured pose --sigma-angle 0.0005")).code, 0);
  EXPECT_NE(slurp(in("data/poses.csv")).find("pr_cov_xx[mm.deg]"), std::string::npos);
  const Outcome run = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal --model geometry");
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST_F(ShakenPoses, NeedOrientationsAndAnInstrumentWithNoise) {
  const Outcome positions = kinfer(simulate(""));
  EXPECT_EQ(positions.code, 2);
  EXPECT_NE(positions.err.find("add --measured pose"), std::string::npos) << positions.err;
  const Outcome exact = kinfer(simulate("--measured pose --sigma-angle 0"));
  EXPECT_EQ(exact.code, 2);
  EXPECT_NE(exact.err.find("larger than 0"), std::string::npos) << exact.err;
}

}  // namespace
}  // namespace kinfer::test
