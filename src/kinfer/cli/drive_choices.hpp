// Drives and sensors of a simulation, as the verbs that simulate name them.
#pragma once

#include <map>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/sensor_model.hpp"
#include "kinfer/simulate/excitation.hpp"

namespace kinfer::cli {

inline const std::map<std::string, Script> scripts{{"standard", Script::standard}, {"sequential", Script::sequential},
                                                   {"together", Script::together}, {"gentle", Script::gentle},
                                                   {"vigorous", Script::vigorous}, {"quick", Script::quick}};

/// A preset, or a data sheet whose name ends in .toml. `also`: words that the verb knows besides, for the complaint.
Result<SensorModel> named_grade(const std::string& name, const std::string& also = "");

}  // namespace kinfer::cli
