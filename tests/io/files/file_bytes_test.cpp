// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/file_bytes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/recording/ins_csv.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

class LargeFile : public testing::Test {
 protected:
  static constexpr std::size_t size = (std::size_t{5} << 23) + 11;  // two blocks and a half
  void SetUp() override {
    for (std::size_t i = 0; text.size() < size; ++i) text += std::to_string(i) + '\n';
    text.resize(size);
    ASSERT_TRUE(write_text_file(path, text));
  }
  void TearDown() override { fs::remove(path); }
  const fs::path path = fs::path(testing::TempDir()) / ("kinfer_file_bytes_" + std::to_string(getpid()));
  std::string text{};
};

TEST_F(LargeFile, IsReadABlockAheadAndWhole) {
  auto bytes = FileBytes::open(path);
  ASSERT_TRUE(bytes);
  EXPECT_LT(bytes->filled().size(), size);
  EXPECT_EQ(bytes->text().size(), size);
  ASSERT_TRUE(bytes->fill_to(bytes->filled().size() + 1));
  bytes->release_before(bytes->filled().size());
  ASSERT_TRUE(bytes->fill_to(2 * size));
  EXPECT_EQ(bytes->filled().substr(size - 100), std::string_view(text).substr(size - 100));
  const FileBytes moved = std::move(*FileBytes::read(path));
  EXPECT_EQ(moved.text(), text);
}

/// Loggers that begin anew cut the file that is being read: a mapped one ended the program by a signal.
TEST_F(LargeFile, ThatIsCutWhileItIsReadIsAnError) {
  auto bytes = FileBytes::open(path);
  ASSERT_TRUE(bytes);
  fs::resize_file(path, 100);
  const auto filled = bytes->fill_to(size);
  ASSERT_FALSE(filled);
  EXPECT_EQ(filled.error().what, path.string() + ": the file has become shorter while it was read");
  EXPECT_EQ(bytes->filled().front(), '0') << "what was read stays";
}

/// Rows and a line without an end that reach over blocks.
TEST_F(LargeFile, RowsThatReachOverABlockAreWhole) {
  std::string log = "t,a_ax,a_ay,a_az,a_gx,a_gy,a_gz\n";
  double t = 0.0;
  while (log.size() < size) log += std::to_string(t += 0.01) + ",0.125,-0.25,9.8125,0.5,0,-0.5\n";
  ASSERT_TRUE(write_text_file(path, log));
  const auto recording = read_ins_csv(path);
  ASSERT_TRUE(recording) << recording.error().what;
  const auto parsed = parse_ins_csv(log, path.string());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(recording->loggers.front().time, parsed->loggers.front().time);
  EXPECT_EQ(recording->sensors.front().acceleration.axis, parsed->sensors.front().acceleration.axis);
  ASSERT_TRUE(write_text_file(path, "t,a_ax,a_ay,a_az,a_gx,a_gy,a_gz\n0," + std::string(size, '1')));
  EXPECT_FALSE(read_ins_csv(path));
}

/// A process' memory has no byte at zero.
TEST(FileBytes, AnInputErrorIsASentence) {
  EXPECT_EQ(read_text_file("/proc/self/mem").error().what, "/proc/self/mem: reading stopped with an input error");
}

TEST(FileBytes, APipeHasNoHeadAndIsReadOnce) {
  const fs::path pipe = fs::path(testing::TempDir()) / ("kinfer_pipe_" + std::to_string(getpid()));
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_head(pipe, 4), "");  // and does not wait for a writer
  EXPECT_FALSE(FileBytes::open("/dev/null"));
  fs::remove(pipe);
}

}  // namespace
}  // namespace kinfer
