// SPDX-License-Identifier: Apache-2.0
// File formats of robot models: a table with one row per format, chosen by the file extension, or of XML by the
// outermost element.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"

namespace kinfer {

struct ModelFormat {
  std::string_view name;                             ///< "URDF"
  std::vector<std::string_view> read_extensions{};   ///< with the dot; the first is the usual one; empty: write only
  std::vector<std::string_view> write_extensions{};  ///< likewise; empty: read only
  std::string_view root_element{};                   ///< of XML: it, not the extension, tells the format
  Result<RobotModel> (*parse)(const std::string& text, const std::string& name_in_messages,
                              const ChainEnds& ends) = nullptr;  ///< `ends`: formats without named links ignore it
  std::string (*format)(const RobotModel& robot, const StandardDeviations& sd) = nullptr;  ///< may drop the deviations
};

/// The table. Files of unknown extension are read as the first format.
std::span<const ModelFormat> model_formats();

/// "TOML, URDF or MJCF"; ".toml, .urdf or .mjcf".
std::string readable_model_formats();
std::string writable_model_extensions();

/// Reads a model by its extension, XML by its outermost element. xacro is refused.
Result<RobotModel> read_robot_model(const std::filesystem::path& path, const ChainEnds& ends = {});

/// Writes a model by its extension. An error for an extension that no format writes.
Result<void> write_robot_model(const std::filesystem::path& path, const RobotModel& robot,
                               const StandardDeviations& sd = {});

}  // namespace kinfer
