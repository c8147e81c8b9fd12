// SPDX-License-Identifier: Apache-2.0
// A foreign file of joint positions or measured points as a table with kinfer's columns.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer {

/// What is wanted of a file that may hold more.
struct PoseTableChoice {
  std::vector<std::string> joints{};  ///< names of the robot's joints
  std::vector<bool> translates{};     ///< one per joint: prismatic
  std::string marker{};               ///< marker or rigid body that is the tool point; empty: the only one
};

struct PoseTable {
  CsvTable table{};                     ///< header in kinfer's names and units; lines are those of the file
  std::deque<std::string> unquoted{};   ///< cells of the file that had quotes inside
  std::vector<std::string> contents{};  ///< markers or joints that the file has
  std::vector<std::string> remarks{};   ///< for the user, one sentence each
};

}  // namespace kinfer
