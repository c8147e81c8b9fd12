// SPDX-License-Identifier: Apache-2.0
// Figures of the calibration report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kinfer::pages {

std::string machine_drawing(const nlohmann::json& evidence);  ///< both chains, poses, error vectors
std::string gain_drawing(const nlohmann::json& evidence);     ///< before and after as two bars
std::string error_histogram(const nlohmann::json& evidence);
std::string errors_per_pose(const nlohmann::json& evidence);
std::string workspace_map(const nlohmann::json& evidence);  ///< top and side view
std::string singular_value_plot(const nlohmann::json& evidence);
std::string correlation_map(const nlohmann::json& evidence);
std::string ladder_plot(const nlohmann::json& evidence);

/// Errors compared on the first screen: lengths, or orientations if nothing else was measured; on held-out rows if
/// there are any.
struct Headline {
  double mean_before = 0.0, mean_after = 0.0, max_before = 0.0, max_after = 0.0;  ///< in `unit`
  int n = 0;
  bool held_out = false;
  std::string unit{};  ///< "mm", "°"
  std::string what{};  ///< "the tool", "the distance", "the tool's orientation"
};
Headline headline(const nlohmann::json& evidence);

/// 95th percentile of the tool error [m]; NaN if there are no rows.
double error_percentile_95(const nlohmann::json& evidence);

}  // namespace kinfer::pages
