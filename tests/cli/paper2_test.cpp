// SPDX-License-Identifier: Apache-2.0
// The verbs and options of paper 2, end to end: swarm searches, warm start, population prior, frames, compensation.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class Paper2 : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const Outcome run = kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --errors " +
                               source("examples/robot6/errors.toml") + " --out data --lowest 0 --clearance 350");
    ASSERT_EQ(run.code, 0) << run.err;
  }
  json evidence(const std::string& folder) const { return json::parse(slurp(in(folder) / "evidence.json")); }
};

TEST_F(Paper2, BpnnPsoWritesANetAndASecondRunIsComparedWithAWarmStartWithoutOne) {
  const std::string calibrate =
      "calibrate --robot data/robot.toml --data data/poses.csv --holdout 0.2 --method bpnn-pso --iterations 300 ";
  const Outcome first = kinfer(calibrate + "--out first");
  EXPECT_LT(first.code, 2) << first.err;
  EXPECT_TRUE(fs::exists(in("first") / "net.txt"));
  const json search = evidence("first")["search"];
  EXPECT_EQ(search["engine"], "bpnn-pso");
  EXPECT_EQ(search["best"].size(), 301u);
  EXPECT_EQ(search["median"].size(), 301u);
  const Outcome second = kinfer(calibrate + "--out second --warm-start first");
  EXPECT_LT(second.code, 2) << second.err;
  std::string starts;
  const json again = evidence("second");
  for (const json& run : again["search"]["side_by_side"]) starts += run["start"].get<std::string>() + ";";
  EXPECT_EQ(starts, "cold;nominal swarm;warm start;net;");
  EXPECT_NE(second.out.find("warm start"), std::string::npos) << second.out;
  EXPECT_NE(slurp(in("second") / "evidence.json").find("--warm-start"), std::string::npos);
}

TEST_F(Paper2, ASwarmSearchGivesTheSameBytesFor1And7Threads) {
  const std::string calibrate =
      "calibrate --robot data/robot.toml --data data/poses.csv --holdout 0.2 --method pso --iterations 50 ";
  ASSERT_LT(kinfer(calibrate + "--out one --threads 1").code, 2);
  ASSERT_LT(kinfer(calibrate + "--out seven --threads 7").code, 2);
  EXPECT_EQ(slurp(in("one") / "evidence.json"), slurp(in("seven") / "evidence.json"));
}

TEST_F(Paper2, APriorOfAnotherRobotTypeIsRefused) {
  std::ofstream(in("two.toml"))
      << "name = \"two\"\nconvention = \"mdh\"\nunits = { length = \"mm\", angle = \"deg\" }\n"
         "[[joint]]\ntype = \"revolute\"\na = 0.0\nalpha = 0.0\nd = 10.0\ntheta = 0.0\n";
  const Outcome run = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal --prior two.toml");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("two.toml: expected an earlier calibration of this kind of robot"), std::string::npos)
      << run.err;
  EXPECT_FALSE(fs::exists(in("cal")));
}

TEST_F(Paper2, CompensatedJointsBringTheCorrectedChainWhereTheNominalOneWas) {
  std::ofstream(in("own.toml"))
      << "units = { length = \"mm\", angle = \"deg\" }\n[errors]\na2 = 0.3\nd4 = -0.2\ntheta3 = 0.05\nalpha5 = 0.02\n";
  ASSERT_EQ(
      kinfer("simulate-poses --robot data/robot.toml --errors own.toml --out own --lowest 0 --clearance 350").code, 0);
  ASSERT_LT(
      kinfer("compensate --chain own/truth.toml --nominal data/robot.toml --joints own/poses.csv -o sent.csv").code, 2);
  ASSERT_EQ(kinfer("predict --chain own/truth.toml --joints sent.csv -o real.csv").code, 0);
  ASSERT_EQ(kinfer("predict --chain data/robot.toml --joints own/poses.csv -o wanted.csv").code, 0);
  std::istringstream real(slurp(in("real.csv"))), wanted(slurp(in("wanted.csv")));
  std::string a, b;
  int exact = 0;  // a joint at its limit may prevent this in a row or two
  for (std::getline(real, a), std::getline(wanted, b); std::getline(real, a) && std::getline(wanted, b);) {
    std::istringstream cells_a(a), cells_b(b);
    double worst = 0.0;
    for (int k = 0; k < 3; ++k) {
      std::getline(cells_a, a, ','), std::getline(cells_b, b, ',');
      worst = std::max(worst, std::abs(std::stod(a) - std::stod(b)));
    }
    exact += worst < 1e-7 ? 1 : 0;
  }
  EXPECT_GE(exact, 47);
}

TEST_F(Paper2, ATargetThatCannotBeReachedIsReportedWithExitCode1) {
  std::ofstream(in("far.csv")) << "x,y,z\n9,0,0\n";
  const Outcome run = kinfer("compensate --chain data/truth.toml --nominal data/robot.toml --targets far.csv");
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("row 0: "), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("residual[mm]"), std::string::npos);
}

TEST_F(Paper2, SweepsOfSingleJointsGiveBaseAndTool) {
  std::ofstream joints(in("joints.csv"));
  joints << "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n";
  for (const int swept : {0, 1, 4})
    for (int i = 0; i < 12; ++i)
      for (int k = 0; k < 6; ++k) joints << (k == swept ? -55 + 10 * i : 0) << (k < 5 ? "," : "\n");
  joints.close();
  ASSERT_EQ(kinfer("predict --chain data/robot.toml --joints joints.csv -o points.csv").code, 0);
  std::istringstream q(slurp(in("joints.csv"))), p(slurp(in("points.csv")));
  std::ofstream sweeps(in("sweeps.csv"));
  std::string a, b;
  std::getline(q, a), std::getline(p, b);
  sweeps << a << ",x,y,z\n";
  while (std::getline(q, a) && std::getline(p, b)) {
    std::size_t third = 0;
    for (int comma = 0; comma < 3; ++comma) third = b.find(',', third) + 1;
    sweeps << a << ',' << b.substr(0, third - 1) << '\n';
  }
  sweeps.close();
  const Outcome run = kinfer("frames --robot data/robot.toml --data sweeps.csv --out frames");
  ASSERT_EQ(run.code, 0) << run.err;
  const json found = evidence("frames");
  EXPECT_EQ(found["kind"], "frames");
  ASSERT_EQ(found["sweeps"].size(), 3u);
  for (const json& sweep : found["sweeps"]) EXPECT_LT(sweep["off_by"], 1e-6);
  ASSERT_EQ(kinfer("predict --chain frames/chain.toml --joints joints.csv -o again.csv").code, 0);
  EXPECT_LT(found["closed_form_start"]["base_differs_m"], 1e-6);
}

}  // namespace
}  // namespace kinfer::test
