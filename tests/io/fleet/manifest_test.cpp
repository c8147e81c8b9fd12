// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Manifest, RowsAreTasksAndComeBackAsWritten) {
  const auto tasks = parse_manifest(
      "verb,key,arguments\n# a comment\ncalibrate,r1,--robot 'my robot.toml' --data a.csv\n"
      "identify,r-2.b,\"log.csv --sensors a,b \"\"x y\"\"\"\n",
      "m.csv");
  ASSERT_TRUE(tasks) << tasks.error().what;
  ASSERT_EQ(tasks->size(), 2u);
  EXPECT_EQ((*tasks)[0].line, 3);
  EXPECT_THAT((*tasks)[0].arguments, ElementsAre("--robot", "my robot.toml", "--data", "a.csv"));
  EXPECT_THAT((*tasks)[1].arguments, ElementsAre("log.csv", "--sensors", "a,b", "x y"));
  const auto again = parse_manifest(format_manifest(*tasks), "again");
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(*again, *tasks);
}

TEST(Manifest, AVerbWithCommasComesBackAsWritten) {
  const std::vector<SweepTask> tasks = parse_manifest("key,verb,arguments\na,\"plan,all\",x\n", "m.csv").value();
  const auto again = parse_manifest(format_manifest(tasks), "m.csv");
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->front().verb, tasks.front().verb);
}

TEST(Manifest, AWordWithBothKindsOfQuotesComesBackAsWritten) {
  std::vector<SweepTask> tasks = parse_manifest("key,verb,arguments\na,plan,x\n", "m.csv").value();
  tasks.front().arguments = {"it's 5\" long", "'\"", "plain"};
  const auto again = parse_manifest(format_manifest(tasks), "m.csv");
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->front().arguments, tasks.front().arguments);
}

TEST(Manifest, BadRowsAreNamedWithTheirLine) {
  const auto what = [](const std::string& rows) {
    return parse_manifest("key,verb,arguments\n" + rows, "m.csv").error().what;
  };
  EXPECT_EQ(what("a,plan,\nb,plan,\na,plan,\n"), "m.csv:4: the key \"a\" stands in line 2 too");
  for (const char* key : {"..", "a/b", ".hidden", "", "a b"})
    EXPECT_THAT(what(fmt::format("\"{}\",plan,\n", key)), HasSubstr("cannot name a folder")) << key;
  EXPECT_THAT(what("a,plan,'open\n"), HasSubstr("m.csv:2: a quoted argument does not end"));
  EXPECT_EQ(what("a,plan,--seed \x01\n"), "m.csv:2: the arguments hold a control character");
  EXPECT_THAT(what(""), HasSubstr("no tasks"));
  EXPECT_THAT(parse_manifest("key,verb\na,plan\n", "m.csv").error().what, HasSubstr("arguments is missing"));
}

TEST(Manifest, FilesMakeTasksNamedAfterWhatTheWildcardsMatch) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_manifest_" + std::to_string(getpid()));
  for (const char* robot : {"r1", "r2"}) {
    fs::create_directories(folder / robot);
    std::ofstream(folder / robot / "poses_a.csv") << "x";
  }
  const auto tasks =
      tasks_of_files((folder / "*" / "poses_*.csv").string(), "calibrate", "--robot {folder}/robot.toml --data {file}");
  ASSERT_TRUE(tasks) << tasks.error().what;
  ASSERT_EQ(tasks->size(), 2u);
  EXPECT_EQ((*tasks)[0].key, "r1_a");
  EXPECT_EQ((*tasks)[1].arguments[1], (folder / "r2" / "robot.toml").string());
  EXPECT_THAT(tasks_of_files((folder / "*" / "poses_?.txt").string(), "calibrate", "").error().what,
              HasSubstr("no file matches"));
  EXPECT_THAT(tasks_of_files("poses.csv", "calibrate", "").error().what, HasSubstr("expected a pattern"));
  fs::remove_all(folder);
}

TEST(Manifest, ASeedDependsOnTheKeyAndTheSweepAlone) {
  EXPECT_EQ(task_seed(1, "a"), task_seed(1, "a"));
  EXPECT_NE(task_seed(1, "a"), task_seed(1, "b"));
  EXPECT_NE(task_seed(1, "a"), task_seed(2, "a"));
}

}  // namespace
}  // namespace kinfer
