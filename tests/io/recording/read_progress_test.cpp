// SPDX-License-Identifier: Apache-2.0
// Long files report how much of them was read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/ins_mcap.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

class ReadProgress : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder);
    std::ofstream csv(folder / "drive.csv");
    csv << "t,boom_ax,boom_ay,boom_az,boom_gx,boom_gy,boom_gz\n";
    for (int row = 0; row < 20000; ++row)
      csv << 0.005 * row << ",0.1,0.2," << 9.8 + std::sin(0.01 * row) << ",0.01,0.02," << std::cos(0.01 * row) << "\n";
  }
  void TearDown() override { fs::remove_all(folder); }

  /// Fractions that reading this file reports.
  static std::vector<double> fractions(const fs::path& path) {
    std::vector<double> all;
    const auto recording = read_recording(std::span(&path, 1), {}, [&](const Progress& progress) {
      EXPECT_EQ(progress.stage, "reading");
      EXPECT_EQ(progress.detail, path.string());
      all.push_back(progress.fraction);
      return ObserverDecision::proceed;
    });
    EXPECT_TRUE(recording) << recording.error().what;
    return all;
  }

  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_read_progress_" + std::to_string(getpid()));
};

TEST_F(ReadProgress, RisesToTheEndForTextAndRobotLogs) {
  ASSERT_TRUE(write_ins_mcap(folder / "drive.mcap", *read_ins_csv(folder / "drive.csv")));
  for (const char* name : {"drive.csv", "drive.mcap"}) {
    const std::vector<double> all = fractions(folder / name);
    ASSERT_GE(all.size(), 4U) << name;
    EXPECT_TRUE(std::ranges::is_sorted(all)) << name;
    EXPECT_GT(all.front(), 0.0) << name;
    EXPECT_GT(all.back(), 0.75) << name;
    EXPECT_LE(all.back(), 1.0) << name;
  }
}

}  // namespace
}  // namespace kinfer
