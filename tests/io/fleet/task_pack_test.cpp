// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/task_pack.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

namespace kinfer {
namespace {

namespace fs = std::filesystem;

class TaskPackFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("kinfer_task_pack_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "task/figures");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::uint64_t append(const std::string& key) const {
    return TaskPack::open(pack())->append(key, folder_ / "task", {"task.json"}).value();
  }
  fs::path pack() const { return folder_ / "results.tar"; }

  fs::path folder_;
};

TEST_F(TaskPackFile, GivesBackWhatWasPutIn) {
  write("task/task.json", "one"), write("task/empty", ""), write("task/figures/a.svg", std::string(5000, 'x'));
  const std::string longest_key(120, 'k');
  for (const std::string& key : {std::string("a"), longest_key, std::string("z.1")}) append(key);
  const auto tasks = packed_tasks(pack());
  ASSERT_TRUE(tasks) << tasks.error().what;
  ASSERT_EQ(tasks->size(), 3U);
  EXPECT_EQ((*tasks)[1].key, longest_key);
  for (const PackedTask& task : *tasks) {
    EXPECT_EQ(read_packed_file(pack(), task.offset, "task.json").value(), "one");
    EXPECT_EQ(read_packed_file(pack(), task.offset, "empty").value(), "");
    EXPECT_FALSE(read_packed_file(pack(), task.offset, "none").value());
  }
  ASSERT_EQ(std::system(("tar xf " + pack().string() + " -C " + folder_.string()).c_str()), 0);
  EXPECT_EQ(fs::file_size(folder_ / "z.1/figures/a.svg"), 5000U);
  EXPECT_EQ(fs::file_size(folder_ / longest_key / "empty"), 0U);
}

TEST_F(TaskPackFile, WhereverItIsCutTheCompleteTasksStay) {
  write("task/task.json", "one");
  append("a");
  const std::uint64_t second = append("b"), size = fs::file_size(pack());
  for (std::uint64_t cut = size - 1; cut > second; cut -= 97) {
    fs::resize_file(pack(), cut);
    EXPECT_EQ(packed_tasks(pack()).value().size(), 1U) << cut;
  }
  EXPECT_EQ(append("b"), second) << "the rest of a partial task is cut off";
  EXPECT_EQ(fs::file_size(pack()), size);
}

TEST_F(TaskPackFile, AForeignFileIsNotCutOff) {
  write("results.tar", std::string(3000, 'x'));
  const auto opened = TaskPack::open(pack());
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().what, ::testing::HasSubstr("no task of a sweep at byte 0"));
  EXPECT_EQ(fs::file_size(pack()), 3000U);
}

}  // namespace
}  // namespace kinfer
