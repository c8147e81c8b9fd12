// SPDX-License-Identifier: Apache-2.0
// Calibration with other instruments, set-ups and models, through the program.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class Robots : public Program {
 protected:
  /// The file with a further column whose cell is `cell(row)`.
  template <class Cell>
  void add_column(const std::string& file, const std::string& name, Cell cell) const {
    std::istringstream lines(slurp(in(file)));
    std::string text, line;
    for (int row = -1; std::getline(lines, line); ++row) text += line + "," + (row < 0 ? name : cell(row)) + "\n";
    write(in(file), text);
  }
};

TEST_F(Robots, AModelIsChosenAndTheChoiceIsInTheEvidence) {
  simulate();
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal").code, 0);
  const json model = json::parse(slurp(in("cal/evidence.json")))["model"];
  EXPECT_EQ(model["chosen"], "geometry");
  ASSERT_GE(model["rungs"].size(), 5u);
  for (const json& rung : model["rungs"]) {
    for (const char* key : {"name", "adds", "terms", "determined", "not_excited", "chosen", "locked", "why"})
      EXPECT_TRUE(rung.contains(key)) << key;
    EXPECT_EQ(rung["locked"].get<bool>(), !rung.contains("holdout")) << rung["name"];
  }
}

TEST_F(Robots, AnUnknownModelTermIsRefusedWithTheKnownOnes) {
  simulate();
  const Outcome run = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal --model magic");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("gravity"), std::string::npos) << run.err;
}

TEST_F(Robots, SetupsAreWrittenAndPredictedByTheirName) {
  simulate();
  add_column("data/poses.csv", "setup", [](int row) { return row % 2 ? "evening" : "morning"; });
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal").code, 0);
  const std::string chain = slurp(in("cal/chain.toml"));
  EXPECT_NE(chain.find("setup = \"morning\""), std::string::npos);
  EXPECT_NE(chain.find("[[mounting]]\nname = \"evening\""), std::string::npos);
  ASSERT_EQ(kinfer("predict --chain cal/chain.toml --joints data/poses.csv -o p.csv").code, 0);
  EXPECT_EQ(kinfer("verify --chain cal/chain.toml --data data/poses.csv").code, 0);
}

TEST_F(Robots, ARobotIsRefittedWithFewPosesAfterACollision) {
  simulate();
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal").code, 0);
  simulate("--seed 9 --poses 8");
  std::string poses = slurp(in("data/poses.csv"));  // the third encoder now reports 0.4 deg less
  std::istringstream lines(poses);
  std::string text, line;
  std::getline(lines, line);
  text = line + "\n";
  while (std::getline(lines, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    cells[2] = std::to_string(std::stod(cells[2]) - 0.4);
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + cells[i];
    text += "\n";
  }
  write(in("knocked.csv"), text);
  EXPECT_EQ(kinfer("verify --chain cal/chain.toml --data knocked.csv").code, 1);
  const Outcome run =
      kinfer("calibrate --robot data/robot.toml --data knocked.csv --refit offsets --warm-start cal --out again");
  EXPECT_EQ(run.code, 0) << run.err << run.out;
  const std::string moved = "theta3 has moved by ";
  const std::size_t at = run.out.find(moved);
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_NEAR(std::stod(run.out.substr(at + moved.size())), 0.4, 2e-3);
  const Outcome alone = kinfer("calibrate --robot data/robot.toml --data knocked.csv --refit offsets --out again");
  EXPECT_EQ(alone.code, 2);
  EXPECT_NE(alone.err.find("--warm-start"), std::string::npos) << alone.err;
}

/// Rows of a public ball-in-socket set as a pose set file.
std::string socket_rows(const std::string& folder, const std::vector<std::string>& positions) {
  std::string text;
  for (const std::string& position : positions)
    for (const char* hole : {"hole_0", "hole_1"}) {
      std::istringstream lines(slurp(folder + "/" + position + "/" + hole + ".csv"));
      for (std::string line; std::getline(lines, line);)
        if (!line.empty()) text += line + "," + position + "_" + hole + "\n";
    }
  return text;
}

TEST_F(Robots, RealBallsInSocketsAreConsistentAtHeldOutPositions) {
  const char* root = std::getenv("KINFER_DATA");
  if (!root) GTEST_SKIP() << "KINFER_DATA is not set";
  const std::string mukca = std::string(root) + "/mukca", arm = mukca + "/data/panda_1";
  const std::string columns = "q1,q2,q3,q4,q5,q6,q7,socket\n";
  write(in("fit.csv"), columns + socket_rows(arm, {"back-high", "right"}));
  write(in("test.csv"), columns + socket_rows(arm, {"front"}));
  const Outcome run =
      kinfer("calibrate --robot " + mukca + "/urdf/panda.urdf --tip-link ball_link --data fit.csv --out cal");
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  ASSERT_EQ(kinfer("predict --chain cal/chain.toml --joints test.csv -o p.csv").code, 0);
  std::istringstream lines(slurp(in("p.csv")));
  std::string line;
  std::getline(lines, line);
  std::vector<std::array<double, 3>> points;
  while (std::getline(lines, line)) {
    std::array<double, 3> p{};
    std::istringstream cells(line);
    for (double& x : p) {
      std::string cell;
      std::getline(cells, cell, ',');
      x = std::stod(cell);
    }
    points.push_back(p);
  }
  double sum = 0.0;
  const std::size_t first = 30;  // rows of hole_0
  for (const auto& [begin, end] : {std::pair{std::size_t{0}, first}, std::pair{first, points.size()}}) {
    std::array<double, 3> centre{};
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k) centre[k] += points[i][k] / static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      sum += std::hypot(points[i][0] - centre[0], points[i][1] - centre[1], points[i][2] - centre[2]);
  }
  EXPECT_LE(1e3 * sum / static_cast<double>(points.size()), 0.70);
}

}  // namespace
}  // namespace kinfer::test
