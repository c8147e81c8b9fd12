// SPDX-License-Identifier: Apache-2.0
// One interface to all orientation filters.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "kinfer/inertial/filters/kinfer_filter.hpp"
#include "kinfer/inertial/filters/kinfer_smoother.hpp"
#include "kinfer/inertial/filters/paper_ekf.hpp"

namespace kinfer {

using FilterOptions = std::variant<KinferFilterOptions, KinferOfflineOptions, PaperEkfOptions>;

/// "kinfer", "kinfer-offline", "paper": the default options of that filter; nullopt for another name.
std::optional<FilterOptions> filter_named(std::string_view name);
std::string_view filter_name(const FilterOptions& options);
inline constexpr std::string_view filter_names = "kinfer, kinfer-offline, paper";

/// The same filter without the magnetometer.
FilterOptions without_magnetometer(FilterOptions options);

/// Orientation of the sensor at each row of its logger, sensor to world (x east, y north, z up; arbitrary heading
/// without magnetometer). Rows without usable measurements repeat the previous row; never NaN.
std::vector<Quat> estimate_orientations(const InsSensor& sensor, std::span<const double> time,
                                        const FilterOptions& options);

}  // namespace kinfer
