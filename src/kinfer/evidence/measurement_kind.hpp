// SPDX-License-Identifier: Apache-2.0
// The kinds of external measurements of a pose.
#pragma once

#include <optional>
#include <string_view>

namespace kinfer {

enum class MeasurementKind { point, orientation, contact, distance, pair, plane, tilt };
inline constexpr int measurement_kinds = 7;

/// The stable identifier for programs: "point", "orientation", "contact", …
std::string_view name(MeasurementKind kind);
std::optional<MeasurementKind> measurement_kind(std::string_view name);

}  // namespace kinfer
