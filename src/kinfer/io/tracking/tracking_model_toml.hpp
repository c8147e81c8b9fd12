// SPDX-License-Identifier: Apache-2.0
// track.toml beside chain.toml (docs/formats.md): what an identification hands over for tracking. SI throughout.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"

namespace kinfer {

/// Geometry with full precision; the covariance as its root, nine digits.
std::string format_tracking_model(const TrackingModel& model);

/// Unknown keys, missing fields, wrong types and broken trees are errors with the line.
Result<TrackingModel> parse_tracking_model(std::string_view text, const std::string& name_in_messages);
Result<TrackingModel> read_tracking_model(const std::filesystem::path& path);

}  // namespace kinfer
