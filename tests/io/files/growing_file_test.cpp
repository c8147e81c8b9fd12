// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/growing_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace kinfer {
namespace {

namespace fs = std::filesystem;

class GrowingLog : public testing::Test {
 protected:
  void SetUp() override { write("t,a\n1,2\n"); }
  void TearDown() override { fs::remove(path_), fs::remove(path_ + ".1"); }
  void write(const std::string& text, std::ios::openmode mode = std::ios::trunc) const {
    std::ofstream(path_, std::ios::out | mode) << text;
  }
  const std::string path_ = testing::TempDir() + "kinfer_growing_" + std::to_string(getpid());
};

TEST_F(GrowingLog, GivesWhatHasArrivedSince) {
  auto file = GrowingFile::open(path_).value();
  EXPECT_EQ(file.read().value(), "t,a\n1,2\n");
  EXPECT_EQ(file.read().value(), "");
  write("3,4\n", std::ios::app);
  EXPECT_EQ(file.read().value(), "3,4\n");
  EXPECT_EQ(file.rotation(), Rotation::none);
}

TEST_F(GrowingLog, KnowsThatItWasCutThoughItIsLongerAgain) {
  for (const std::string now : {"", "t,a\n", "t,a\n9,9\n", "t,a\n9,9\n10,10\n11,11\n"}) {
    write("t,a\n1,2\n");
    auto file = GrowingFile::open(path_).value();
    ASSERT_TRUE(file.read());
    write(now);
    EXPECT_EQ(file.rotation(), Rotation::cut) << now;
    file = GrowingFile::open(path_).value();
    EXPECT_EQ(file.read().value(), now);
    EXPECT_EQ(file.rotation(), Rotation::none) << now;
  }
}

TEST_F(GrowingLog, KnowsThatAnotherOneStandsInItsPlace) {
  const auto file = GrowingFile::open(path_).value();
  fs::rename(path_, path_ + ".1");
  EXPECT_EQ(file.rotation(), Rotation::none) << "not yet";
  write("t,a\n1,2\n");
  EXPECT_EQ(file.rotation(), Rotation::replaced);
}

TEST_F(GrowingLog, ThatIsMissingIsAnError) {
  EXPECT_FALSE(GrowingFile::open(path_ + ".none"));
}

}  // namespace
}  // namespace kinfer
