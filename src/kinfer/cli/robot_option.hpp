// --robot FILE (TOML or URDF) with --base-link and --tip-link, as every verb that takes a robot has it.
#pragma once

#include "kinfer/cli/common.hpp"
#include "kinfer/io/pose_set_csv.hpp"
#include "kinfer/io/robot_toml.hpp"

namespace kinfer::cli {

struct RobotOption {
  std::string path, base_link, tip_link;
};
void add_robot_option(CLI::App& verb, RobotOption& option, const std::string& name, const std::string& help,
                      Need need = Need::required);

/// Reads by the ending: .urdf and .xml are URDF, all else is TOML.
Result<RobotModel> read_robot(const RobotOption& option);

/// What --columns names; without it, the names in the files are kinfer's own.
Result<ColumnMap> read_columns_option(const std::string& path);

}  // namespace kinfer::cli
