// SPDX-License-Identifier: Apache-2.0
// The user's own URDF with calibrated origins, through the program.
#include <cmath>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

class ModelPatches : public Program {
 protected:
  /// robot.urdf: the example robot as a user's file, with comments and a mesh; data/poses.csv.
  void make_inputs(const std::string& more = "") const {
    simulate(more);
    ASSERT_EQ(kinfer("convert " + source("examples/robot6/robot.toml") + " robot.urdf").code, 0);
    std::string text = slurp(in("robot.urdf"));
    const std::string link = "<link name=\"link_J3\"/>";
    ASSERT_NE(text.find(link), std::string::npos);
    text.replace(text.find(link), link.size(),
                 "<!-- ours -->\r\n<link name='link_J3'><visual><geometry><mesh "
                 "filename=\"package://m/j3.dae\"/></geometry></visual></link>");
    write(in("robot.urdf"), text);
  }

  /// Largest difference of x, y, z [m] of two outputs of predict.
  double largest_difference(const std::string& one, const std::string& other) const {
    std::istringstream a(slurp(in(one))), b(slurp(in(other)));
    std::string line_a, line_b;
    double largest = 0.0;
    int rows = 0;
    for (std::getline(a, line_a), std::getline(b, line_b); std::getline(a, line_a) && std::getline(b, line_b); ++rows) {
      std::istringstream cells_a(line_a), cells_b(line_b);
      for (int k = 0; k < 3; ++k) {
        std::string cell_a, cell_b;
        std::getline(cells_a, cell_a, ','), std::getline(cells_b, cell_b, ',');
        largest = std::max(largest, std::abs(std::stod(cell_a) - std::stod(cell_b)));
      }
    }
    EXPECT_GT(rows, 20);
    return largest;
  }
};

/// The text without what stands between the quotes of an <origin>.
std::string without_origin_values(std::string text) {
  for (std::size_t at = text.find("<origin "); at != std::string::npos; at = text.find("<origin ", at + 1))
    text.replace(at, text.find("/>", at) - at, "<origin ");
  return text;
}

TEST_F(ModelPatches, TheUsersFileHasNewOriginsAndEveryOtherByte) {
  make_inputs("--measured pose");
  const Outcome run = kinfer("calibrate --robot robot.urdf --tip-link link_J6 --data data/poses.csv --out cal");
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  EXPECT_NE(run.out.find("robot_calibrated.urdf is your file with the origins of 6 joints changed"), std::string::npos)
      << run.out;
  const std::string before = slurp(in("robot.urdf")), after = slurp(in("cal/robot_calibrated.urdf"));
  EXPECT_NE(before, after);
  EXPECT_EQ(without_origin_values(before), without_origin_values(after));
  for (const char* file : {"joint_origins.yaml", "model_changes.csv", "placement.toml"})
    EXPECT_TRUE(fs::exists(in(std::string("cal/") + file))) << file;
  EXPECT_FALSE(fs::exists(in("cal/kinematics.yaml"))) << "neither a UR nor a Franka";
  EXPECT_EQ(kinfer("calibrate --robot robot.urdf --tip-link link_J6 --data data/poses.csv --out again").code, 0);
  EXPECT_EQ(slurp(in("again/robot_calibrated.urdf")), after);
}

TEST_F(ModelPatches, ItsToolPosesAreThoseOfTheCalibratedChain) {
  make_inputs("--measured pose");
  ASSERT_EQ(kinfer("calibrate --robot robot.urdf --tip-link link_J6 --data data/poses.csv --out cal").code, 0);
  std::string chain = slurp(in("cal/chain.toml"));  // base and tool are not in the robot's file
  for (const char* key : {"\nbase = ", "\ntool = "}) {
    const std::size_t at = chain.find(key);
    ASSERT_NE(at, std::string::npos) << chain;
    chain.replace(at, 7, std::string("\n") + key[1] + "_was = ");
    chain.erase(at + 1, chain.find('\n', at + 1) - at);
  }
  for (const char* key : {"base_sd = ", "tool_sd = "})
    if (const std::size_t at = chain.find(key); at != std::string::npos) chain.erase(at, chain.find('\n', at) + 1 - at);
  write(in("bare.toml"), chain);
  const Outcome bare = kinfer("predict --chain bare.toml --joints data/poses.csv -o bare.csv");
  ASSERT_EQ(bare.code, 0) << bare.err << chain;
  ASSERT_EQ(
      kinfer("predict --chain cal/robot_calibrated.urdf --tip-link link_J6 --joints data/poses.csv -o file.csv").code,
      0);
  EXPECT_LT(largest_difference("bare.csv", "file.csv"), 1e-9);
}

TEST_F(ModelPatches, OffsetsAreSeparateOnlyWhereAFileIsWrittenBack) {
  make_inputs("--measured pose");
  const Outcome run =
      kinfer("calibrate --robot robot.urdf --tip-link link_J6 --data data/poses.csv --out cal --offsets separate");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(slurp(in("cal/joint_origins.yaml")).find("joint_offsets:\n  J1: "), std::string::npos);
  const Outcome refused = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out no --offsets separate");
  EXPECT_EQ(refused.code, 2);
  EXPECT_FALSE(fs::exists(in("no")));
  EXPECT_NE(refused.err.find("--offsets has no effect here"), std::string::npos) << refused.err;
}

/// The text without the values of the attributes that place a body.
std::string without_places(std::string text) {
  for (const char* key : {" pos=\"", " quat=\""})
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
      const std::size_t begin = at + std::string(key).size();
      text.erase(begin, text.find('"', begin) - begin);
    }
  return text;
}

TEST_F(ModelPatches, TheUsersMjcfIsWrittenBackLikewise) {
  simulate("--measured pose");
  ASSERT_EQ(kinfer("convert " + source("examples/robot6/robot.toml") + " robot.xml").code, 0);
  std::string before = slurp(in("robot.xml"));
  const std::size_t at = before.find("<joint name=\"J3\"");
  ASSERT_NE(at, std::string::npos) << before;
  before.insert(at, "<!-- ours -->\r\n<geom type='mesh' mesh=\"j3\"/>");
  write(in("robot.xml"), before);
  const Outcome run = kinfer("calibrate --robot robot.xml --tip-link link_J6 --data data/poses.csv --out cal");
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  EXPECT_NE(run.out.find("robot_calibrated.xml is your file with the frames of 6 joints changed"), std::string::npos)
      << run.out;
  const std::string after = slurp(in("cal/robot_calibrated.xml"));
  EXPECT_NE(before, after);
  EXPECT_EQ(without_places(before), without_places(after));
  for (const char* file : {"model_changes.csv", "placement.toml"})
    EXPECT_TRUE(fs::exists(in(std::string("cal/") + file))) << file;
  for (const char* file : {"joint_origins.yaml", "joint_offsets.yaml", "kinematics.yaml"})
    EXPECT_FALSE(fs::exists(in(std::string("cal/") + file))) << file;
  EXPECT_NE(slurp(in("cal/placement.toml")).find("link = \"link_J6\""), std::string::npos);
  EXPECT_EQ(kinfer("verify --chain cal/robot_calibrated.xml --tip-link link_J6 --data data/poses.csv").code, 1)
      << "base and tool are those of the cell, not of the file";
  const Outcome separate =
      kinfer("calibrate --robot robot.xml --tip-link link_J6 --data data/poses.csv --out apart --offsets separate");
  ASSERT_EQ(separate.code, 0) << separate.err;
  EXPECT_NE(slurp(in("apart/joint_offsets.yaml")).find("joint_offsets:\n  J1: "), std::string::npos);
  EXPECT_NE(separate.out.find("add those of joint_offsets.yaml"), std::string::npos) << separate.out;
}

TEST_F(ModelPatches, EveryVerbThatTakesARobotReadsMjcf) {
  simulate();
  ASSERT_EQ(kinfer("convert " + source("examples/robot6/robot.toml") + " robot.xml").code, 0);
  for (const char* arguments :
       {"inspect data/poses.csv --robot robot.xml", "plan --robot robot.xml --poses 4 -o plan.csv",
        "simulate-poses --robot robot.xml --poses 5 --out simulated",
        "predict --chain robot.xml --tip-link tool --joints data/poses.csv -o predicted.csv",
        "convert robot.xml same.toml",
        "compensate --chain same.toml --nominal robot.xml --joints data/poses.csv -o corrected.csv"}) {
    const Outcome run = kinfer(arguments);
    EXPECT_EQ(run.code, 0) << arguments << "\n" << run.err << run.out;
  }
  ASSERT_EQ(kinfer("predict --chain data/robot.toml --joints data/poses.csv -o nominal.csv").code, 0);
  EXPECT_LT(largest_difference("predicted.csv", "nominal.csv"), 1e-9);
}

TEST_F(ModelPatches, AXacroFileMustBeExpandedFirst) {
  write(in("arm.urdf.xacro"), "<robot/>");
  write(in("p.csv"), "q1\n0\n");
  const Outcome run = kinfer("predict --chain arm.urdf.xacro --joints p.csv -o -");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("xacro arm.urdf.xacro > robot.urdf"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace kinfer::test
