// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/recording_formats.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "kinfer/io/recording/ins_csv.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

std::string log_of(const std::string& sensor) {
  std::string text =
      "t," + sensor + "_ax," + sensor + "_ay," + sensor + "_az," + sensor + "_gx," + sensor + "_gy," + sensor + "_gz\n";
  for (int row = 0; row < 5; ++row) text += std::to_string(0.01 * row) + ",0,0,9.8,0,0,0\n";
  return text;
}

class RecordingFormats : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder);
    write("a.csv", log_of("a"));
    write("b.log", log_of("b"));
    write("poses.csv", "q1,x,y,z\n0,1,2,3\n");
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const char* name, const std::string& text) const { std::ofstream(folder / name) << text; }
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_recording_formats_" + std::to_string(getpid()));
};

TEST_F(RecordingFormats, ARecordingIsRecognisedByItsContentNotItsName) {
  EXPECT_TRUE(is_recording(folder / "a.csv"));
  EXPECT_TRUE(is_recording(folder / "b.log"));
  EXPECT_FALSE(is_recording(folder / "poses.csv"));
  EXPECT_FALSE(is_recording(folder / "none.csv"));
}

TEST_F(RecordingFormats, FilesAreJoinedAsLoggersInTheirOrder) {
  const std::vector<fs::path> paths{folder / "b.log", folder / "a.csv"};
  const auto read = read_recording(paths), expected = read_ins_csv(paths);
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->sensors.size(), 2u);
  EXPECT_EQ(read->sensors[0].name, "b");
  EXPECT_EQ(read->sensors[1].logger, 1u);
  EXPECT_EQ(read->time(read->sensors[1])[4], expected->time(expected->sensors[1])[4]);
  EXPECT_EQ(read->sensors[1].acceleration.axis[2], expected->sensors[1].acceleration.axis[2]);
}

TEST_F(RecordingFormats, AFileOfNoKnownFormatHasTheSentenceOfTheFirst) {
  const std::vector<fs::path> poses{folder / "poses.csv"}, none{folder / "none.csv"};
  EXPECT_EQ(read_recording(poses).error().what, read_ins_csv(poses).error().what);
  EXPECT_EQ(read_recording(none).error().what, (folder / "none.csv").string() + ": no such file");
}

}  // namespace
}  // namespace kinfer
