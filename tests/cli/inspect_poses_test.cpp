// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class InspectPoses : public Program {
 protected:
  void simulate(const std::string& more = "") const {
    const Outcome run = kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") +
                               " --out data --lowest 0 --clearance 350 " + more);
    ASSERT_EQ(run.code, 0) << run.err;
  }
  /// poses.csv with every row changed.
  template <class Change>
  void change_rows(Change change) const {
    std::istringstream before(slurp(in("data/poses.csv")));
    std::string line, after;
    for (int number = 0; std::getline(before, line); ++number) after += change(line, number) + "\n";
    write(in("data/poses.csv"), after);
  }
};

TEST_F(InspectPoses, AFaultlessSetIsReportedAsSuch) {
  simulate();
  const Outcome run = kinfer("inspect data/poses.csv --robot data/robot.toml");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("nothing wrong was found"), std::string::npos) << run.out;
  EXPECT_EQ(kinfer("inspect data/poses.csv --robot data/robot.toml --json").out, "[]\n");
}

TEST_F(InspectPoses, AHeaderWithTheWrongUnitIsFoundAndCalibrateReportsTheCorrection) {
  simulate();
  change_rows([](std::string line, int number) {
    return number == 0 ? "q1,q2,q3,q4,q5,q6,x[mm],y[mm],z[mm]" : line;  // degrees, read as radians
  });
  const json findings = json::parse(kinfer("inspect data/poses.csv --robot data/robot.toml --json").out);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0]["kind"], "degrees_for_radians");
  EXPECT_TRUE(findings[0]["applied"]);
  const Outcome run = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal");
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("corrected before the fit"), std::string::npos) << run.out;
  const json evidence = json::parse(slurp(in("cal/evidence.json")));
  EXPECT_EQ(evidence["findings"][0]["kind"], "degrees_for_radians");
  EXPECT_LT(evidence["after"]["holdout"]["mean"], 6e-5);
}

TEST_F(InspectPoses, EulerAnglesInAnotherSequenceAreFound) {
  simulate("--measured pose --poses 30");
  const Outcome poses = kinfer("predict --chain data/truth.toml --joints data/poses.csv -o poses.csv");
  ASSERT_EQ(poses.code, 0) << poses.err;
  // Rotations R = Rz(c) Ry(b) Rx(a) as fixed-axis angles a, b, c in degrees.
  std::istringstream joints(slurp(in("data/poses.csv"))), truth(slurp(in("poses.csv")));
  std::string joint_line, line, file = "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],px,py,pz,A,B,C\n";
  std::getline(joints, joint_line), std::getline(truth, line);
  while (std::getline(joints, joint_line) && std::getline(truth, line)) {
    double v[7];
    std::istringstream cells(line);
    std::string cell;
    for (double& number : v) std::getline(cells, cell, ','), number = std::stod(cell);
    const double w = v[3], x = v[4], y = v[5], z = v[6], deg = 180 / 3.14159265358979;
    std::istringstream q(joint_line);
    for (int k = 0; k < 6; ++k) std::getline(q, cell, ','), file += cell + ",";
    std::ostringstream rest;
    rest.precision(12);
    rest << v[0] << ',' << v[1] << ',' << v[2] << ',' << deg * std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
         << ',' << deg * std::asin(2 * (w * y - x * z)) << ','
         << deg * std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) << '\n';
    file += rest.str();
  }
  write(in("theirs.csv"), file);
  const std::string names =
      "q1=\"q1 [deg]\"\nq2=\"q2 [deg]\"\nq3=\"q3 [deg]\"\nq4=\"q4 [deg]\"\nq5=\"q5 [deg]\"\nq6=\"q6 [deg]\"\n"
      "x=\"px\"\ny=\"py\"\nz=\"pz\"\n";
  write(in("map.toml"),
        "euler=\"XYZ intrinsic\"\n[columns]\n" + names + "rx=\"A [rad]\"\nry=\"B [rad]\"\nrz=\"C [rad]\"\n");
  const Outcome run = kinfer("inspect theirs.csv --robot data/robot.toml --columns map.toml");
  EXPECT_NE(run.out.find("XYZ extrinsic angles in deg"), std::string::npos) << run.out << run.err;
}

/// Public measured sets; every finding here was checked by hand and is true.
TEST_F(InspectPoses, MeasuredSetsHaveTrueFindingsOnly) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  const std::string common = "inspect --json --robot " + source("data/ur10/robot.toml") + " --columns " +
                             source("data/ur10/leica_columns.toml") + " " + root + "/ur10_leica/";
  EXPECT_EQ(kinfer(common + "Series_C_measurements_random_poses.csv").out, "[]\n");
  const json b = json::parse(kinfer(common + "Series_B_measurements_joint_configurations.csv").out);
  std::vector<std::string> kinds;
  for (const json& finding : b) kinds.push_back(finding["kind"]);
  // The tracker's numbers appear twice, to the last digit, although elbow and shoulder have changed configuration.
  EXPECT_EQ(kinds, (std::vector<std::string>{"measurement_repeated", "measurement_repeated", "gross_outliers"}));
}

TEST_F(InspectPoses, ReferenceCasesHaveNoFindingButTheirGrossErrors) {
  const char* root = std::getenv("KINFER_CASES");
  if (!root) GTEST_SKIP() << "KINFER_CASES is not set";
  for (const std::string name : {"robot6_tracker", "ur_like_metres", "scara_screw"}) {
    const std::string folder = std::string(root) + "/calibrate/" + name;
    EXPECT_EQ(kinfer("inspect --json --robot " + folder + "/robot.toml " + folder + "/poses.csv").out, "[]\n") << name;
  }
  const std::string folder = std::string(root) + "/calibrate/arm7_outliers";
  std::vector<int> rows;
  for (const json& finding :
       json::parse(kinfer("inspect --json --robot " + folder + "/robot.toml " + folder + "/poses.csv").out))
    for (const int row : finding["rows"]) rows.push_back(row);
  std::sort(rows.begin(), rows.end());
  EXPECT_EQ(rows, (std::vector<int>{11, 37, 44, 52, 53, 68, 72, 73, 75}));
}

}  // namespace
}  // namespace kinfer::test
