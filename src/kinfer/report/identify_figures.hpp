// Figures of the identification report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kinfer::pages {

std::string found_machine_drawing(const nlohmann::json& evidence);  ///< segments, INS, axes, what nothing tells
std::string tree_drawing(const nlohmann::json& evidence);           ///< which segment hangs on which
std::string explained_drawing(const nlohmann::json& evidence);      ///< motion and what of it stays unexplained
std::string trace_drawings(const nlohmann::json& evidence);         ///< predicted against measured, a plot a sensor

}  // namespace kinfer::pages
