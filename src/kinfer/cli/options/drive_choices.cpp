// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/drive_choices.hpp"

#include <fmt/ranges.h>

#include "kinfer/io/recording/sensor_grade_toml.hpp"

namespace kinfer::cli {

Result<SensorModel> read_grade(const std::string& name, const std::string& also) {
  if (const auto grade = sensor_grade(name)) return *grade;
  if (name.ends_with(".toml")) return read_sensor_grade(name);
  return error("{}: no such sensor grade; known are {}{}, or a file that ends in .toml", name,
               also.empty() ? "" : also + ", ", fmt::join(sensor_grade_names, ", "));
}

}  // namespace kinfer::cli
