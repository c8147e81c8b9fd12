// SPDX-License-Identifier: Apache-2.0
// Runs the program as a user would and reads its output.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace kinfer::test {

namespace fs = std::filesystem;

inline std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// A temporary folder of the test, empty at the start.
class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("kinfer_") + info->test_suite_name() + "_" + info->name() + "_" +
                                           std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path in(const std::string& name) const { return folder_ / name; }

  /// Runs `kinfer arguments` inside the test's folder.
  Outcome kinfer(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && '" KINFER_PROGRAM "' " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), slurp(in("out.txt")), slurp(in("err.txt"))};
  }

  /// data/: poses of the example robot with the errors of paper 2's table 3.
  void simulate(const std::string& more = "") const {
    const Outcome run =
        kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --errors " +
               source("examples/robot6/errors.toml") + " --out data --lowest 0 --clearance 350 " + more);
    ASSERT_EQ(run.code, 0) << run.err;
  }

  /// targets.csv: the tool poses of the example robot at these rows of six joint positions [deg].
  void predict_targets(const std::string& rows) const {
    write(in("joints.csv"), "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n" + rows);
    const Outcome run =
        kinfer("predict --chain " + source("examples/robot6/robot.toml") + " --joints joints.csv -o targets.csv");
    ASSERT_EQ(run.code, 0) << run.err;
  }

  std::string source(const std::string& path) const { return std::string(KINFER_SOURCE_DIR) + "/" + path; }

  fs::path folder_;
};

}  // namespace kinfer::test
