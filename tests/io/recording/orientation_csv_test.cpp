// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/recording/orientation_csv.hpp"

namespace kinfer {
namespace {

TEST(OrientationCsv, HasOneRowPerInputRowAndEmptyCellsForOtherLoggers) {
  InsRecording recording;
  recording.loggers = {{"a.csv", {0.0, 0.25}}, {"b.csv", {7.5}}};
  recording.sensors.resize(2);
  recording.sensors[0].name = "left";
  recording.sensors[1].name = "right";
  recording.sensors[1].logger = 1;
  const auto path = std::filesystem::temp_directory_path() / "kinfer_orientation_csv_test.csv";
  ASSERT_TRUE(
      write_orientation_csv(path, recording, {{0, {Quat(1, 0, 0, 0), Quat(0, 1, 0, 0)}}, {1, {Quat(0.6, 0, 0, 0.8)}}}));
  EXPECT_EQ(read_text_file(path).value(),
            "t,left_qw,left_qx,left_qy,left_qz,right_qw,right_qx,right_qy,right_qz\n"
            "0,1.0000000,0.0000000,0.0000000,0.0000000,,,,\n"
            "0.25,0.0000000,1.0000000,0.0000000,0.0000000,,,,\n"
            "7.5,,,,,0.6000000,0.0000000,0.0000000,0.8000000\n");
  std::filesystem::remove(path);
}

TEST(OrientationCsv, APathThatCannotBeWrittenIsAnError) {
  const auto done = write_orientation_csv("/no such folder/q.csv", {}, {});
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().what.find("does the folder exist"), std::string::npos);
}

}  // namespace
}  // namespace kinfer
