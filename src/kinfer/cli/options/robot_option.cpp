// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/robot_option.hpp"

namespace kinfer::cli {

void add_robot_option(CLI::App& verb, RobotOption& option, const std::string& name, const std::string& help,
                      Requirement need) {
  add_text(verb, name, option.path, help, need, "FILE");
  begin_group(verb, "Robot file");
  add_text(verb, "--base-link", option.base_link,
           "Link of a URDF file or body of an MJCF file where the chain begins (default: its root, the world)");
  add_text(
      verb, "--tip-link", option.tip_link,
      "Link of a URDF file, body or site of an MJCF file where the chain ends (default: the end of its longest arm)");
  begin_group(verb, "Options");
}

Result<RobotModel> read_robot(const RobotOption& option) {
  return read_robot_model(option.path, {option.base_link, option.tip_link});
}

Result<ColumnMap> read_columns_option(const std::string& path) {
  return path.empty() ? ColumnMap{} : read_column_map(path);
}

}  // namespace kinfer::cli
