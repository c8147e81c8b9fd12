// SPDX-License-Identifier: Apache-2.0
// --robot FILE (any readable format) with --base-link and --tip-link, shared by all verbs that take a robot.
#pragma once

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/model_formats.hpp"

namespace kinfer::cli {

struct RobotOption {
  std::string path, base_link, tip_link;
};
void add_robot_option(CLI::App& verb, RobotOption& option, const std::string& name, const std::string& help,
                      Requirement need = Requirement::required);

/// By file extension, see model_formats.
Result<RobotModel> read_robot(const RobotOption& option);

/// The column map of --columns; without it, kinfer's own column names are expected.
Result<ColumnMap> read_columns_option(const std::string& path);

}  // namespace kinfer::cli
