// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/foreign/pose_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "io/pose_set/foreign_pose_samples.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/io/pose_set/pose_log.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using namespace test;
using ::testing::HasSubstr;

/// shoulder and elbow, both revolute.
Chain two_revolute_joints() {
  Chain chain;
  for (int j = 0; j < 2; ++j)
    chain.joints.push_back(Joint{.name = j == 0 ? "shoulder" : "elbow", .parent = j - 1, .link = MdhLink{}});
  return chain;
}

class PoseTables : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  Result<PoseLog> read(const std::string& text, RequiredContent required, const PoseLogChoice& choice = {}) const {
    std::ofstream(folder / "log.txt", std::ios::binary) << text;
    return read_pose_log(folder / "log.txt", chain, choice, required);
  }
  Result<PoseLog> read_points(const std::string& text, const std::string& marker = "") const {
    return read(text, RequiredContent::targets, {.marker = marker});
  }

  const Chain chain = two_revolute_joints();
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_pose_tables_" + std::to_string(getpid()));
};

void expect_joints(const Result<PoseLog>& log, const char* format, int first_line) {
  ASSERT_TRUE(log) << log.error().what;
  EXPECT_EQ(log->format, format);
  ASSERT_EQ(log->set.rows(), pose_rows);
  EXPECT_EQ(log->set.line.front(), first_line);
  for (int row = 0; row < pose_rows; ++row)
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(log->set.joints(j, row), sample_joint(j, row), 1e-8) << row;
  EXPECT_NEAR(log->set.time.back() - log->set.time.front(), (pose_rows - 1) / pose_rate, 1e-6);
}

/// `missing`: rows that have no position of the marker.
void expect_points(const Result<PoseLog>& log, const char* format, int missing) {
  ASSERT_TRUE(log) << log.error().what;
  EXPECT_EQ(log->format, format);
  ASSERT_EQ(log->set.points.size(), static_cast<std::size_t>(pose_rows - missing));
  EXPECT_LT((log->set.points.front().position - sample_point(0)).norm(), 1e-8);
  EXPECT_LT((log->set.points.back().position - sample_point(pose_rows - 1)).norm(), 1e-8);
}

TEST_F(PoseTables, UrRtdeIsSeparatedByBlanksInRadians) {
  expect_joints(read(ur_rtde(), RequiredContent::joints_only), "UR RTDE csv", 2);
}

TEST_F(PoseTables, KukaRsiTelegramsAreFoundWhateverTheirLines) {
  expect_joints(read(kuka_rsi(), RequiredContent::joints_only), "KUKA RSI telegrams", 1);
  expect_joints(read(kuka_rsi_table(), RequiredContent::joints_only), "KUKA RSI telegrams", 2);
}

TEST_F(PoseTables, OpenSimCoordinatesAreToldByTheNamesOfJoints) {
  expect_joints(read(opensim_mot(), RequiredContent::joints_only), "OpenSim storage (.sto, .mot)", 8);
}

TEST_F(PoseTables, OpenSimMarkersNeedTheMarkersName) {
  expect_points(read_points(opensim_trc(), "tip"), "OpenSim markers (.trc)", 1);
  EXPECT_THAT(read_points(opensim_trc()).error().what,
              HasSubstr("the file has 2 markers (tip, base); --marker NAME says which is the tool point"));
  EXPECT_THAT(read_points(opensim_trc(), "tool").error().what,
              HasSubstr("there is no marker \"tool\"; the file has tip, base"));
}

TEST_F(PoseTables, QualisysWithAndWithoutColumnNames) {
  for (const bool has_names : {true, false}) {
    const auto log = read_points(qualisys_tsv(has_names), "tip");
    expect_points(log, "Qualisys tsv", 1);
    EXPECT_NEAR(log->set.time.back(), (pose_rows - 1) / pose_rate, 1e-6);
  }
}

TEST_F(PoseTables, MotiveTakesTheRigidBodyInAnyUnit) {
  for (const auto& [unit, metres] :
       {std::pair("Meters", 1.0), std::pair("Millimeters", 1e-3), std::pair("Centimeters", 1e-2)}) {
    const auto log = read_points(motive_csv(unit, metres));
    expect_points(log, "OptiTrack Motive csv", 1);
    ASSERT_EQ(log->set.orientations.size(), log->set.points.size());
    EXPECT_NEAR(log->set.orientations[0].orientation.w(), 0.8, 1e-9);
    EXPECT_NEAR(log->set.orientations[0].orientation.z(), 0.6, 1e-9);
  }
  EXPECT_THAT(read_points(motive_csv("Furlongs", 200.0)).error().what, HasSubstr("\"Furlongs\" is not read"));
}

TEST_F(PoseTables, SpatialAnalyzerNamesItsPoints) {
  const auto log = read_points(spatial_analyzer());
  expect_points(log, "SpatialAnalyzer text", 0);
  EXPECT_EQ(log->set.id.front(), "p1");
  EXPECT_TRUE(log->remarks.empty()) << "the comment states the unit";
}

TEST_F(PoseTables, ABareListIsInMillimetresUnlessItsExtentIsThatOfMetres) {
  for (const char* separator : {" ", "\t", ";", ", "})
    for (const double unit : {1e-3, 1.0}) {
      const auto log = read_points(bare_list(separator, unit));
      expect_points(log, "list of points", 0);
      ASSERT_EQ(log->remarks.size(), 1U);
      EXPECT_THAT(log->remarks[0], HasSubstr(unit < 1.0 ? "they are read in mm" : "they are read in m"));
    }
}

TEST_F(PoseTables, FilesOnTheWrongSideAreNamed) {
  EXPECT_THAT(read_points(ur_rtde()).error().what, HasSubstr("this is UR RTDE csv, which holds joint positions"));
  EXPECT_THAT(read(spatial_analyzer(), RequiredContent::joints_only).error().what,
              HasSubstr("this is SpatialAnalyzer text, which holds measured points; expected joint positions"));
}

TEST_F(PoseTables, BadInputGetsOneSentence) {
  const auto joints = [&](const std::string& text) { return read(text, RequiredContent::joints_only).error().what; };
  EXPECT_THAT(joints("timestamp actual_q_0 actual_q_1\n0 0.1\n"), HasSubstr("log.txt:2: expected 3 columns, found 2"));
  EXPECT_THAT(joints("<Rob><AIPos A1=\"1\" A2=\"2\"/></Rob>"), HasSubstr("log.txt:1: a telegram without <IPOC>"));
  EXPECT_THAT(joints("<Rob><AIPos A1=\"1\"/><IPOC>5</IPOC></Rob>"), HasSubstr("a telegram without A2 in <AIPos>"));
  EXPECT_THAT(joints("inDegrees=yes\nendheader\ntime\tknee\n0\t1\n"), HasSubstr("the file has knee"));
  EXPECT_THAT(read_points("NO_OF_FRAMES\t1\nNO_OF_CAMERAS\t1\n1\t2\t3\n").error().what,
              HasSubstr("neither MARKER_NAMES nor BODY_NAMES"));
  EXPECT_THAT(read_points("PathFileType\t4\nUnits\ninch\nFrame#\tTime\tA\n").error().what,
              HasSubstr("expected the unit mm or m under \"Units\", found \"inch\""));
  EXPECT_THAT(read_points("// Unit: inch\np1 1 2 3\np2 4 5 6\n").error().what, HasSubstr("the unit inch is not read"));
}

TEST(PoseTableMutations, AnyBytesAreReadOrRefusedWithOneSentence) {
  constexpr std::string_view bytes = "0123456789.,-+eE\n\r#\"[]()/t_;\tagmxyz nan:<>=\xff";
  const std::vector<std::string> samples{
      ur_rtde(),          kuka_rsi(),          kuka_rsi_table(),          opensim_mot(),      opensim_trc(),
      qualisys_tsv(true), qualisys_tsv(false), motive_csv("Meters", 1.0), spatial_analyzer(), bare_list(" ", 1e-3)};
  const PoseTableChoice choice{.joints = {"shoulder", "elbow"}, .translates = {false, false}, .marker = "tip"};
  Rng rng(8);
  int accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = samples[static_cast<std::size_t>(i) % samples.size()];
    for (std::uint64_t n = 1 + rng.index(6); n > 0 && !text.empty(); --n) {
      const std::size_t at = rng.index(text.size());
      if (rng.index(2))
        text[at] = bytes[rng.index(bytes.size())];
      else
        text.erase(at, 1 + rng.index(30));
    }
    for (const PoseTableFormat& format : pose_table_formats())
      for (const PoseTableChoice* wanted : {&choice, static_cast<const PoseTableChoice*>(nullptr)}) {
        const auto found = format.read(text, "log", wanted);
        if (found)
          ++accepted;
        else
          ASSERT_EQ(found.error().what.rfind("log", 0), 0U) << found.error().what;
      }
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace kinfer
