// SPDX-License-Identifier: Apache-2.0
// All orientation filters behind one interface: a table with one row per filter.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinfer/inertial/filters/filter_output.hpp"
#include "kinfer/inertial/filters/kinfer_filter.hpp"
#include "kinfer/inertial/filters/kinfer_smoother.hpp"
#include "kinfer/inertial/filters/paper_ekf.hpp"

namespace kinfer {

/// The options select the filter.
using FilterOptions = std::variant<KinferFilterOptions, KinferOfflineOptions, PaperEkfOptions>;

/// Where the heading of a segment comes from when segments are compared.
enum class HeadingSource {
  gyro,    ///< gyro alone, and one constant rotation per segment towards its magnetometer
  filter,  ///< the filter's own heading at each row
};

/// A filter. The functions take options of this filter only.
struct OrientationFilter {
  std::string_view name;              ///< as in --filter
  std::string_view help;              ///< a few words for the help text
  FilterOptions default_options{};    ///< their alternative identifies the filter
  bool is_causal = true;              ///< each orientation depends on the rows up to it only
  bool estimates_gyro_errors = true;  ///< FilterOutput holds bias and scale of the gyro
  HeadingSource heading_source = HeadingSource::gyro;

  FilterOutput (*run)(const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) = nullptr;
  MagnetometerUse& (*magnetometer)(FilterOptions& options) = nullptr;  ///< the option itself
  /// Accepts an initial rest at any gyro bias up to `limit` [rad/s]; null: the filter has no such limit.
  void (*set_max_initial_bias)(FilterOptions& options, double limit) = nullptr;
  /// The gyroscope's bias at the start [rad/s] and its standard deviation; null: the filter takes none.
  void (*set_bias)(FilterOptions& options, const Vec3& bias, double sd) = nullptr;
};

/// The table, in the order of the help text.
std::span<const OrientationFilter> orientation_filters();

/// The row of these options.
const OrientationFilter& filter_of(const FilterOptions& options);

/// The default options of the filter of that name; nullopt for another name.
std::optional<FilterOptions> filter_named(std::string_view name);

/// "kinfer, kinfer-offline, paper", for error texts; and with the help of each, for help texts.
std::string filter_names();
std::string filter_help();

/// Whether the filter uses a magnetometer.
MagnetometerUse magnetometer_use(FilterOptions options);

/// The same filter without the magnetometer; with another limit of the initial bias, if it has one; and started with a
/// bias, if it takes one.
FilterOptions without_magnetometer(FilterOptions options);
FilterOptions with_max_initial_bias(FilterOptions options, double limit);
FilterOptions with_bias(FilterOptions options, const Vec3& bias, double sd);

/// Runs the filter of the options. Rows without usable measurements repeat the previous row; never NaN.
FilterOutput run_filter(const InsSensor& sensor, std::span<const double> time, const FilterOptions& options);

/// Orientation of the sensor at each row of its logger, sensor to world (x east, y north, z up; arbitrary heading
/// without magnetometer).
std::vector<Quat> estimate_orientations(const InsSensor& sensor, std::span<const double> time,
                                        const FilterOptions& options);

}  // namespace kinfer
