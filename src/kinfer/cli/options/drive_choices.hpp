// SPDX-License-Identifier: Apache-2.0
// Names of the drives and sensor grades on the command line.
#pragma once

#include <map>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/excitation.hpp"

namespace kinfer::cli {

inline const std::map<std::string, Script> drive_scripts{
    {"standard", Script::standard}, {"sequential", Script::sequential}, {"together", Script::together},
    {"gentle", Script::gentle},     {"vigorous", Script::vigorous},     {"quick", Script::quick}};

/// A preset, or a data sheet whose name ends in .toml. `also`: further names that the verb accepts, for the error
/// message.
Result<SensorModel> read_grade(const std::string& name, const std::string& also = "");

}  // namespace kinfer::cli
