// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/text_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

namespace kinfer {
namespace {

namespace fs = std::filesystem;

class TextFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override {
    fs::permissions(folder, fs::perms::owner_all);
    fs::remove_all(folder);
  }
  const fs::path folder = fs::path(testing::TempDir()) / ("kinfer_text_file_" + std::to_string(getpid()));
};

TEST_F(TextFile, WritingThenReadingGivesTheSameTextAndNoOtherFile) {
  const std::string text = std::string("line\r\n\0byte", 11);
  ASSERT_TRUE(write_text_file(folder / "a.txt", "before"));
  ASSERT_TRUE(write_text_file(folder / "a.txt", text));
  EXPECT_EQ(*read_text_file(folder / "a.txt"), text);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}), 1);
}

TEST_F(TextFile, PathsThatCannotBeReadAreErrors) {
  const std::string name = folder.string();
  EXPECT_EQ(read_text_file(folder / "none.csv").error().what, name + "/none.csv: no such file");
  EXPECT_EQ(read_text_file(folder).error().what, name + ": expected a file, found a folder");
  ASSERT_TRUE(write_text_file(folder / "empty.csv", ""));
  EXPECT_EQ(read_text_file(folder / "empty.csv").error().what, name + "/empty.csv: the file is empty");
}

TEST_F(TextFile, WhatGzipCompressedIsNamed) {
  ASSERT_TRUE(write_text_file(folder / "a.csv.gz", std::string("\x1F\x8B\x08\x00", 4)));
  EXPECT_EQ(
      read_text_file(folder / "a.csv.gz").error().what,
      folder.string() + "/a.csv.gz: compressed by gzip, which is not read; unpack it (gunzip), or compress it by zstd");
}

TEST_F(TextFile, PathsThatCannotBeWrittenAreErrors) {
  const std::string name = folder.string();
  EXPECT_EQ(write_text_file(folder, "x").error().what, name + ": expected a file to write, found a folder");
  EXPECT_EQ(write_text_file(folder / "none/a.txt", "x").error().what,
            name + "/none/a.txt: the file cannot be written; does the folder exist, and may you write there?");
}

TEST_F(TextFile, LinksStayAndWhatTheyPointToIsReplaced) {
  ASSERT_TRUE(write_text_file(folder / "target.txt", "before"));
  fs::create_symlink("target.txt", folder / "link.txt");
  ASSERT_TRUE(write_text_file(folder / "link.txt", "after"));
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(*read_text_file(folder / "target.txt"), "after");
}

TEST_F(TextFile, APipeIsWrittenAndNotReplaced) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_text_file(pipe, "rows"));
  std::array<char, 8> bytes{};
  EXPECT_EQ(::read(reader, bytes.data(), bytes.size()), 4);
  EXPECT_STREQ(bytes.data(), "rows");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(TextFile, AnOutputFolderIsMadeOrRefusedBeforeAnythingIsComputed) {
  EXPECT_TRUE(create_writable_folder(folder / "deep/er"));
  EXPECT_TRUE(fs::is_empty(folder / "deep/er"));
  ASSERT_TRUE(write_text_file(folder / "file", "x"));
  EXPECT_EQ(create_writable_folder(folder / "file").error().what,
            (folder / "file").string() + ": the output folder cannot be created");
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(create_writable_folder(folder).error().what, folder.string() + ": the output folder is not writable");
}

}  // namespace
}  // namespace kinfer
