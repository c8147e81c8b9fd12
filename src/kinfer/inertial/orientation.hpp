// Every orientation filter of the house behind one function.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "kinfer/inertial/kinfer_filter.hpp"
#include "kinfer/inertial/kinfer_offline.hpp"
#include "kinfer/inertial/paper_ekf.hpp"

namespace kinfer {

using FilterOptions = std::variant<KinferFilterOptions, KinferOfflineOptions, PaperEkfOptions>;

/// "kinfer", "kinfer-offline", "paper": options with their defaults; nothing for another name.
std::optional<FilterOptions> filter_named(std::string_view name);
inline constexpr std::string_view filter_names = "kinfer, kinfer-offline, paper";

/// The same filter that leaves the magnetometer alone.
FilterOptions without_magnetometer(FilterOptions options);

/// Orientation of the sensor at each of its logger's rows, sensor to world (x east, y north, z up; without magnetometer
/// any heading). Rows that say nothing repeat the row before; never NaN.
std::vector<Quat> orientations(const InsSensor& sensor, std::span<const double> time, const FilterOptions& options);

}  // namespace kinfer
