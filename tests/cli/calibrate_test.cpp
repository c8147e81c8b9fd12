// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class Calibrate : public Program {
 protected:
  Outcome calibrate_robot(const std::string& more = "") const {
    return kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal " + more);
  }
};

TEST_F(Calibrate, SimulatedRobotIsCalibratedEndToEnd) {
  simulate();
  const Outcome run = calibrate_robot();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out.find("Use it: "), 0u) << run.out;
  for (const char* file : {"chain.toml", "chain.urdf", "evidence.json", "run.json"})
    EXPECT_TRUE(fs::exists(in("cal") / file)) << file;
  const json evidence = json::parse(slurp(in("cal/evidence.json")));
  EXPECT_EQ(evidence["format"], "kinfer-evidence/1");
  EXPECT_EQ(evidence["kind"], "calibrate");
  EXPECT_LT(evidence["after"]["holdout"]["mean"], 6e-5);  // measured against noisy points: 27 µm of noise per axis
  EXPECT_GT(evidence["before"]["holdout"]["mean"], 3e-4);
  EXPECT_EQ(evidence["after"]["holdout"]["n"], 50);
  EXPECT_EQ(evidence["rank"], 27);
  for (const char* key : {"verdict", "nominal", "before", "after", "parameters", "confounded", "outliers", "model",
                          "predicted_error", "search"})
    EXPECT_TRUE(evidence.contains(key)) << key;
  const json& parameter = evidence["parameters"][0];
  for (const char* key : {"name", "nominal", "value", "sd", "unit", "identifiable"})
    EXPECT_TRUE(parameter.contains(key)) << key;
}

TEST_F(Calibrate, PredictionsOfTheCorrectedChainAndOfItsUrdfAgree) {
  simulate();
  ASSERT_EQ(calibrate_robot().code, 0);
  const Outcome toml = kinfer("predict --chain cal/chain.toml --joints data/poses.csv -o toml.csv");
  ASSERT_EQ(toml.code, 0) << toml.err;
  const Outcome urdf = kinfer("predict --chain cal/chain.urdf --tip-link tool --joints data/poses.csv -o urdf.csv");
  ASSERT_EQ(urdf.code, 0) << urdf.err;
  std::istringstream a(slurp(in("toml.csv"))), b(slurp(in("urdf.csv")));
  std::string line_a, line_b;
  std::getline(a, line_a), std::getline(b, line_b);
  EXPECT_EQ(line_a, "x,y,z,qw,qx,qy,qz,sd_x,sd_y,sd_z,sd_rx,sd_ry,sd_rz");
  EXPECT_EQ(line_b, "x,y,z,qw,qx,qy,qz") << "a URDF holds no uncertainty";
  EXPECT_EQ(toml.err, "");
  EXPECT_NE(urdf.err.find("the poses come without standard deviations"), std::string::npos) << urdf.err;
  int rows = 0;
  while (std::getline(a, line_a) && std::getline(b, line_b)) {
    std::istringstream cells_a(line_a), cells_b(line_b);
    std::string cell_a, cell_b;
    while (std::getline(cells_a, cell_a, ',') && std::getline(cells_b, cell_b, ','))
      EXPECT_NEAR(std::stod(cell_a), std::stod(cell_b), 1e-9);
    ++rows;
  }
  EXPECT_EQ(rows, 50);
}

TEST_F(Calibrate, SameBytesForAnyNumberOfThreadsAndAnyFolder) {
  simulate();
  ASSERT_EQ(calibrate_robot("--threads 1").code, 0);
  const std::string chain = slurp(in("cal/chain.toml")), evidence = slurp(in("cal/evidence.json"));
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out elsewhere/deep --threads 7").code, 0);
  EXPECT_EQ(slurp(in("elsewhere/deep/chain.toml")), chain);
  EXPECT_EQ(slurp(in("elsewhere/deep/evidence.json")), evidence);
}

TEST_F(Calibrate, VerbsThatWriteOneFileReportItAndQuietIsSilent) {
  simulate();
  const std::string predict = "predict --chain data/robot.toml --joints data/poses.csv -o predicted.csv";
  EXPECT_EQ(kinfer(predict).out, "predicted.csv: 50 poses\n");
  EXPECT_EQ(kinfer("convert data/robot.toml robot.urdf").out, "robot.urdf: 6 joints\n");
  for (const std::string& command : {predict, std::string("convert data/robot.toml robot.urdf")}) {
    const Outcome quiet = kinfer(command + " --quiet");
    EXPECT_EQ(quiet.code, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
  }
}

TEST_F(Calibrate, JsonIsOneObjectOnStdoutAndQuietIsSilent) {
  simulate();
  const Outcome as_json = calibrate_robot("--json");
  const json headline = json::parse(as_json.out);
  EXPECT_TRUE(headline["use"]);
  EXPECT_LT(headline["after"]["holdout"]["mean"], headline["before"]["holdout"]["mean"]);
  const Outcome quiet = calibrate_robot("--quiet");
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
}

TEST_F(Calibrate, VerifyAcceptsNewDataOfTheSameRobotAndRefusesAMovedTracker) {
  simulate();
  ASSERT_EQ(calibrate_robot().code, 0);
  const fs::path first = in("data/poses.csv");
  fs::rename(first, in("first.csv"));
  simulate("--seed 2");
  const Outcome good = kinfer("verify --chain cal/chain.toml --data data/poses.csv");
  EXPECT_EQ(good.code, 0) << good.out;
  EXPECT_EQ(good.out.find("Still good"), 0u);
  const Outcome as_nominal = kinfer("verify --chain data/robot.toml --data data/poses.csv");
  EXPECT_EQ(as_nominal.code, 1) << as_nominal.out;
}

TEST_F(Calibrate, VerifyReadsWhatCalibrateReadInTheSameUnits) {
  simulate();
  ASSERT_EQ(calibrate_robot().code, 0);
  std::string text = slurp(in("data/poses.csv"));
  const std::string units = "x[mm],y[mm],z[mm]";
  ASSERT_NE(text.find(units), std::string::npos);
  write(in("no_units.csv"), text.replace(text.find(units), units.size(), "x,y,z"));
  const Outcome run = kinfer("verify --chain cal/chain.toml --data no_units.csv");
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("the measured positions are millimetres, but were read as metres; corrected here"),
            std::string::npos)
      << run.out;
}

TEST_F(Calibrate, AHeldOutFileIsNeverFitted) {
  simulate();
  fs::copy(in("data/poses.csv"), in("aside.csv"));
  simulate("--seed 3");
  const Outcome run = calibrate_robot("--holdout aside.csv --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const json headline = json::parse(run.out);
  EXPECT_EQ(headline["after"]["train"]["n"], 50);
  EXPECT_EQ(headline["after"]["holdout"]["n"], 50);
}

TEST_F(Calibrate, ConvertRoundTripsThroughUrdf) {
  ASSERT_EQ(kinfer("convert " + source("examples/robot6/robot.toml") + " robot.urdf").code, 0);
  ASSERT_EQ(kinfer("convert robot.urdf back.toml").code, 0);
  write(in("joints.csv"), "q1,q2,q3,q4,q5,q6\n0.1,-0.2,0.3,-0.4,0.5,-0.6\n1,0.5,-0.5,2,1,-3\n");
  ASSERT_EQ(kinfer("predict --chain back.toml --joints joints.csv -o a.csv").code, 0);
  ASSERT_EQ(kinfer("predict --chain " + source("examples/robot6/robot.toml") + " --joints joints.csv -o b.csv").code,
            0);
  std::istringstream a(slurp(in("a.csv"))), b(slurp(in("b.csv")));
  std::string line_a, line_b;
  std::getline(a, line_a), std::getline(b, line_b);
  while (std::getline(a, line_a) && std::getline(b, line_b)) EXPECT_NEAR(std::stod(line_a), std::stod(line_b), 1e-9);
}

TEST_F(Calibrate, InspectReportsWhatWasRead) {
  simulate();
  const Outcome run = kinfer("inspect data/poses.csv --robot data/robot.toml");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("50 poses of 6 joints; measured: 50 positions"), std::string::npos) << run.out;
}

/// Wrong input: exit code 2, one sentence that holds `words`, and no output folder.
struct BadInput {
  std::string name, poses, words;
};
void PrintTo(const BadInput& bad, std::ostream* out) {
  *out << bad.name;
}
const std::string header = "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],x[mm],y[mm],z[mm]\n";

class BadPoses : public Program, public ::testing::WithParamInterface<BadInput> {};

TEST_P(BadPoses, IsRefusedInOneSentenceAndNothingIsWritten) {
  const BadInput& bad = GetParam();
  if (bad.name != "missing") write(in("poses.csv"), bad.poses);
  const Outcome run =
      kinfer("calibrate --robot " + source("examples/robot6/robot.toml") + " --data poses.csv --out cal");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(bad.words), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(in("cal")));
}

INSTANTIATE_TEST_SUITE_P(
    all, BadPoses,
    ::testing::Values(BadInput{"missing", "", "poses.csv"}, BadInput{"empty", "", "poses.csv"},
                      BadInput{"header_only", header, "no rows"},
                      BadInput{"ragged", header + "1,2,3,4,5,6,7,8\n", "poses.csv:2: expected 9 columns, found 8"},
                      BadInput{"not_a_number", header + "1,2,3,4,5,6,7,8,nine\n", "column z"},
                      BadInput{"nan", header + "1,2,3,4,5,6,7,8,nan\n", "poses.csv:2"},
                      BadInput{"infinite", header + "1,2,3,4,5,6,7,inf,9\n", "poses.csv:2"},
                      BadInput{"unknown_unit", "q1[grad],q2,q3,q4,q5,q6,x,y,z\n1,2,3,4,5,6,7,8,9\n", "grad"},
                      BadInput{"wrong_dimension", "q1,q2,q3,q4,q5,q6,x[deg],y,z\n1,2,3,4,5,6,7,8,9\n", "deg"},
                      BadInput{"five_joints", "q1,q2,q3,q4,q5,x,y,z\n1,2,3,4,5,7,8,9\n", "expected 6 joint columns"},
                      BadInput{"twice", "q1,q1,q2,q3,q4,q5,q6,x,y,z\n1,1,2,3,4,5,6,7,8,9\n", "q1"},
                      BadInput{"thousands", header + "1,2,3,4,5,6,7,8,\"1.234,5\"\n", "1.234,5"},
                      BadInput{"too_few", header + "1,2,3,4,5,6,7,8,9\n2,3,4,5,6,7,8,9,10\n", "at least"}),
    [](const auto& bad) { return bad.param.name; });

TEST_F(Calibrate, AnOutputFolderThatCannotBeMadeIsAnErrorBeforeAnythingIsComputed) {
  simulate();
  write(in("file"), "in the way");
  const Outcome run = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out file/cal");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("file/cal"), std::string::npos) << run.err;
}

TEST_F(Calibrate, UsageErrorsAreExitCode2AndHelpIs0) {
  EXPECT_EQ(kinfer("").code, 2);
  EXPECT_EQ(kinfer("nonsense").code, 2);
  EXPECT_EQ(kinfer("calibrate").code, 2);
  EXPECT_EQ(kinfer("--help").code, 0);
  EXPECT_EQ(kinfer("--version").out.find("kinfer "), 0u);
  for (const char* verb : {"inspect", "calibrate", "predict", "verify", "convert", "simulate-poses"}) {
    const Outcome help = kinfer(std::string(verb) + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Example:"), std::string::npos) << verb;
  }
}

/// Reference cases, simulated and scored by independent code, where KINFER_CASES is set.
class ReferenceCases : public Program, public ::testing::WithParamInterface<std::pair<const char*, double>> {};

TEST_P(ReferenceCases, HeldOutErrorIsWithin13TimesTheReference) {
  const char* root = std::getenv("KINFER_CASES");
  if (!root) GTEST_SKIP() << "KINFER_CASES is not set";
  const auto [name, reference_mm] = GetParam();
  const std::string folder = std::string(root) + "/calibrate/" + name;
  const Outcome run = kinfer("calibrate --robot " + folder + "/robot.toml --data " + folder + "/poses.csv --out cal");
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(kinfer("predict --chain cal/chain.toml --joints " + folder + "/joints.csv -o p.csv").code, 0);
  std::istringstream predicted(slurp(in("p.csv"))), truth(slurp(folder + "/truth.csv"));
  std::string line_p, line_t;
  std::getline(predicted, line_p), std::getline(truth, line_t);
  const double scale = line_t.find("[mm]") != std::string::npos ? 1e-3 : 1.0;
  double sum = 0.0;
  int n = 0;
  while (std::getline(predicted, line_p) && std::getline(truth, line_t)) {
    std::istringstream p(line_p), t(line_t);
    std::string cell_p, cell_t;
    double squares = 0.0;
    for (int k = 0; k < 3; ++k) {
      std::getline(p, cell_p, ','), std::getline(t, cell_t, ',');
      squares += std::pow(std::stod(cell_p) - scale * std::stod(cell_t), 2);
    }
    sum += std::sqrt(squares), ++n;
  }
  EXPECT_LE(1e3 * sum / n, 1.3 * reference_mm);
}

INSTANTIATE_TEST_SUITE_P(all, ReferenceCases,
                         ::testing::Values(std::pair{"robot6_tracker", 0.020}, std::pair{"ur_like_metres", 0.013},
                                           std::pair{"scara_screw", 0.012}, std::pair{"arm7_outliers", 0.028}),
                         [](const auto& test) { return std::string(test.param.first); });

TEST_F(Calibrate, ExactlyTheGrossErrorsOfTheOutlierCaseAreListed) {
  const char* root = std::getenv("KINFER_CASES");
  if (!root) GTEST_SKIP() << "KINFER_CASES is not set";
  const std::string folder = std::string(root) + "/calibrate/arm7_outliers";
  ASSERT_EQ(kinfer("calibrate --robot " + folder + "/robot.toml --data " + folder + "/poses.csv --out cal").code, 0);
  std::vector<int> rows;
  const json evidence = json::parse(slurp(in("cal/evidence.json")));
  for (const json& outlier : evidence["outliers"]) rows.push_back(outlier["row"]);
  EXPECT_EQ(rows, (std::vector<int>{11, 37, 44, 52, 53, 68, 72, 73, 75}));
}

/// The real robot, where KINFER_DATA is set.
TEST_F(Calibrate, RealUr10SeriesReachTheirTargets) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  const std::string folder = std::string(root) + "/ur10_leica/";
  for (const auto& [file, limit_mm] : {std::pair{"Series_B_measurements_joint_configurations.csv", 0.22},
                                       std::pair{"Series_C_measurements_random_poses.csv", 0.165}}) {
    const Outcome run =
        kinfer("calibrate --robot " + source("data/ur10/robot.toml") + " --columns " +
               source("data/ur10/leica_columns.toml") + " --data " + folder + file + " --out cal --holdout 0.5 --json");
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_LE(1e3 * json::parse(run.out)["after"]["holdout"]["mean"].get<double>(), limit_mm) << file;
  }
}

}  // namespace
}  // namespace kinfer::test
