// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/measurement_kind.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

/// In the order of the enumerators.
constexpr std::array<std::string_view, measurement_kinds> kind_names{"point", "orientation", "contact", "distance",
                                                                     "pair",  "plane",       "tilt"};

}  // namespace

std::string_view name(MeasurementKind kind) {
  return kind_names[static_cast<std::size_t>(kind)];
}

std::optional<MeasurementKind> measurement_kind(std::string_view name) {
  const auto at = std::ranges::find(kind_names, name);
  if (at == kind_names.end()) return std::nullopt;
  return static_cast<MeasurementKind>(at - kind_names.begin());
}

}  // namespace kinfer
