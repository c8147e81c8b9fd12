// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/robot_option.hpp"

#include <filesystem>

namespace kinfer::cli {
namespace {

std::string chain_of_folder(const std::string& path) {
  std::error_code none;
  const std::filesystem::path inside = std::filesystem::path(path) / "chain.toml";
  return std::filesystem::is_regular_file(inside, none) ? inside.string() : path;
}

}  // namespace

void add_model_file(CLI::App& verb, const std::string& name, std::string& path, const std::string& help,
                    Requirement need, const std::string& placeholder) {
  add_text(verb, name, path, help, need, placeholder);
  replace_text(verb, name.substr(name.rfind(',') + 1), chain_of_folder);
}

void add_robot_option(CLI::App& verb, RobotOption& option, const std::string& name, const std::string& help,
                      Requirement need) {
  add_model_file(verb, name, option.path, help, need, "FILE");
  begin_group(verb, "Robot file");
  add_text(verb, "--base-link", option.base_link,
           "Link of a URDF file or body of an MJCF file where the chain begins (default: its root, the world)");
  add_text(verb, "--tip-link", option.tip_link,
           "Link of a URDF file, body or site of an MJCF file where the chain ends (default: the tool in a file "
           "that kinfer wrote, else the end of its longest arm, or the site \"tool\" there)");
  begin_group(verb, "Options");
}

void add_chain_option(CLI::App& verb, RobotOption& option, const std::string& help) {
  add_robot_option(verb, option, "chain,--chain", help + "; --chain may be left out");
}

Result<RobotModel> read_robot(const RobotOption& option) {
  return read_robot_model(option.path, {option.base_link, option.tip_link});
}

Result<ColumnMap> read_columns_option(const std::string& path) {
  return path.empty() ? ColumnMap{} : read_column_map(path);
}

}  // namespace kinfer::cli
