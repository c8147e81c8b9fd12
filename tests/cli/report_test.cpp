// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

namespace kinfer::test {
namespace {

class Report : public Program {
 protected:
  void calibrate_robot() const {
    ASSERT_EQ(kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --errors " +
                     source("examples/robot6/errors.toml") + " --out data")
                  .code,
              0);
    ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal --quiet").code, 0);
  }

  /// What the program prints on a terminal.
  std::string on_terminal(const std::string& environment) const {
    const std::string command =
        "cd '" + folder_.string() + "' && " + environment +
        " TERM=xterm script -qec '" KINFER_PROGRAM
        " calibrate --robot data/robot.toml --data data/poses.csv --out cal' tty.txt >/dev/null 2>&1";
    if (std::system(command.c_str()) != 0) return "";
    return slurp(in("tty.txt"));
  }
};

TEST_F(Report, IsWrittenByCalibrateAndMadeAgainByteForByte) {
  calibrate_robot();
  const std::string first = slurp(in("cal/report.html"));
  ASSERT_GT(first.size(), 10000u);
  EXPECT_NE(first.find("Use it"), std::string::npos);
  fs::remove(in("cal/report.html"));
  const Outcome again = kinfer("report cal");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(slurp(in("cal/report.html")) == first);
}

TEST_F(Report, HoldsNothingThatDiffersFromRunToRun) {
  calibrate_robot();
  const std::string first = slurp(in("cal/report.html"));
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out other --quiet --threads 1").code, 0);
  EXPECT_TRUE(slurp(in("other/report.html")) == first);
  EXPECT_EQ(first.find(folder_.string()), std::string::npos);
}

TEST_F(Report, OfAFolderWithoutEvidenceIsBadInput) {
  const Outcome run = kinfer("report .");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("evidence.json"), std::string::npos) << run.err;
}

TEST_F(Report, VerdictIsColouredOnATerminalUnlessNOCOLORSaysNo) {
  calibrate_robot();
  const std::string coloured = on_terminal("env -u NO_COLOR");
  if (coloured.empty()) GTEST_SKIP() << "script(1) makes no terminal here";
  EXPECT_NE(coloured.find("\033[1;32mUse it"), std::string::npos);
  EXPECT_EQ(on_terminal("env NO_COLOR=1").find("\033[1"), std::string::npos);
}

}  // namespace
}  // namespace kinfer::test
