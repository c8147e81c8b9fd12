// SPDX-License-Identifier: Apache-2.0
// --robot FILE or CHAIN (any readable format) with --base-link and --tip-link, shared by all verbs that take a robot.
#pragma once

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/model_formats.hpp"

namespace kinfer::cli {

/// A model's file, or the folder that `identify` or `calibrate` wrote: the value becomes the chain.toml in it, so that
/// whatever reads, fingerprints or names the file has the same one.
void add_model_file(CLI::App& verb, const std::string& name, std::string& path, const std::string& help,
                    Requirement need, const std::string& placeholder);

struct RobotOption {
  std::string path, base_link, tip_link;
};
void add_robot_option(CLI::App& verb, RobotOption& option, const std::string& name, const std::string& help,
                      Requirement need = Requirement::required);

/// CHAIN as first argument or --chain, required.
void add_chain_option(CLI::App& verb, RobotOption& option,
                      const std::string& help = "Chain: chain.toml or the folder it is in, a robot TOML, URDF or MJCF");

/// By file extension, see model_formats.
Result<RobotModel> read_robot(const RobotOption& option);

/// The column map of --columns; without it, kinfer's own column names are expected.
Result<ColumnMap> read_columns_option(const std::string& path);

}  // namespace kinfer::cli
