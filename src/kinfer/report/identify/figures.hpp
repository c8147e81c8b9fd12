// SPDX-License-Identifier: Apache-2.0
// Figures of the identification report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kinfer::pages {

std::string identified_machine_drawing(
    const nlohmann::json& evidence);                           ///< segments, INS, axes, unobservable directions
std::string tree_drawing(const nlohmann::json& evidence);      ///< tree of the segments
std::string residual_drawing(const nlohmann::json& evidence);  ///< rms of the motion and of its residual
std::string trace_drawings(const nlohmann::json& evidence);    ///< predicted and measured signals of each trace

}  // namespace kinfer::pages
