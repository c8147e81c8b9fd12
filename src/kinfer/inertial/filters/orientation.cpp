// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// Runs an online filter. Rows before its first orientation get that one.
template <class Filter>
FilterOutput run_online(const InsSensor& sensor, std::span<const double> time, Filter filter) {
  std::vector<Quat> out(time.size());
  std::size_t first = time.size();
  for (std::size_t row = 0; row < time.size(); ++row) {
    filter.add(sample(sensor, time, row));
    if (first == time.size() && filter.started()) first = row;
    out[row] = filter.orientation().normalized();
  }
  for (std::size_t row = 0; row < first && first < time.size(); ++row) out[row] = out[first];
  return {.world_q_sensor = std::move(out)};
}

/// The bias of the initial estimate is within the limit by five standard deviations.
void accept_initial_bias(KinferFilterOptions& options, double limit) {
  options.rest.max_gyro_bias = limit;
  options.bias_sd = limit / 5.0;
}

void start_with_bias(KinferFilterOptions& options, const Vec3& bias, double sd) {
  options.bias = bias;
  options.bias_sd = sd;
}

}  // namespace

std::span<const OrientationFilter> orientation_filters() {
  static const std::array filters{
      OrientationFilter{
          .name = "kinfer",
          .help = "online, error-state Kalman filter",
          .default_options = KinferFilterOptions{},
          .is_causal = true,
          .estimates_gyro_errors = false,  // only as they converge; the rests give one bias for all rows
          .heading_source = HeadingSource::gyro,
          .run =
              [](const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) {
                return run_online(sensor, time, KinferFilter(std::get<KinferFilterOptions>(options)));
              },
          .magnetometer = [](FilterOptions& options) -> MagnetometerUse& {
            return std::get<KinferFilterOptions>(options).magnetometer;
          },
          .set_max_initial_bias =
              [](FilterOptions& options, double limit) {
                accept_initial_bias(std::get<KinferFilterOptions>(options), limit);
              },
          .set_bias = [](FilterOptions& options, const Vec3& bias,
                         double sd) { start_with_bias(std::get<KinferFilterOptions>(options), bias, sd); }},
      OrientationFilter{
          .name = "kinfer-offline",
          .help = "smoothed, each row also uses the rows after it",
          .default_options = KinferOfflineOptions{},
          .is_causal = false,
          .estimates_gyro_errors = true,
          .heading_source = HeadingSource::gyro,
          .run =
              [](const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) {
                return smooth_orientation(sensor, time, std::get<KinferOfflineOptions>(options));
              },
          .magnetometer = [](FilterOptions& options) -> MagnetometerUse& {
            return std::get<KinferOfflineOptions>(options).filter.magnetometer;
          },
          .set_max_initial_bias =
              [](FilterOptions& options, double limit) {
                accept_initial_bias(std::get<KinferOfflineOptions>(options).filter, limit);
              },
          .set_bias = [](FilterOptions& options, const Vec3& bias,
                         double sd) { start_with_bias(std::get<KinferOfflineOptions>(options).filter, bias, sd); }},
      OrientationFilter{.name = "paper",
                        .help = "the 12-state filter of Péntek et al. 2021",
                        .default_options = PaperEkfOptions{},
                        .is_causal = true,
                        .estimates_gyro_errors = false,
                        .heading_source = HeadingSource::filter,
                        .run =
                            [](const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) {
                              return run_online(sensor, time, PaperEkf(std::get<PaperEkfOptions>(options)));
                            },
                        .magnetometer = [](FilterOptions& options) -> MagnetometerUse& {
                          return std::get<PaperEkfOptions>(options).magnetometer;
                        }},
  };
  static_assert(filters.size() == std::variant_size_v<FilterOptions>, "one row per filter");
  return filters;
}

const OrientationFilter& filter_of(const FilterOptions& options) {
  const std::span<const OrientationFilter> filters = orientation_filters();
  const auto row = std::ranges::find_if(
      filters, [&](const OrientationFilter& f) { return f.default_options.index() == options.index(); });
  KINFER_EXPECT(row != filters.end(), "no filter has the options {}", options.index());
  return *row;
}

std::optional<FilterOptions> filter_named(std::string_view name) {
  const std::span<const OrientationFilter> filters = orientation_filters();
  const auto row = std::ranges::find(filters, name, &OrientationFilter::name);
  return row == filters.end() ? std::nullopt : std::optional(row->default_options);
}

std::string filter_names() {
  std::string text;
  for (const OrientationFilter& filter : orientation_filters())
    text += fmt::format("{}{}", text.empty() ? "" : ", ", filter.name);
  return text;
}

std::string filter_help() {
  std::string text;
  for (const OrientationFilter& filter : orientation_filters())
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", filter.name, filter.help);
  return text;
}

MagnetometerUse magnetometer_use(FilterOptions options) {
  return filter_of(options).magnetometer(options);
}

FilterOptions without_magnetometer(FilterOptions options) {
  filter_of(options).magnetometer(options) = MagnetometerUse::off;
  return options;
}

FilterOptions with_max_initial_bias(FilterOptions options, double limit) {
  if (const auto set = filter_of(options).set_max_initial_bias) set(options, limit);
  return options;
}

FilterOptions with_bias(FilterOptions options, const Vec3& bias, double sd) {
  if (const auto set = filter_of(options).set_bias) set(options, bias, sd);
  return options;
}

FilterOutput run_filter(const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) {
  return filter_of(options).run(sensor, time, options);
}

std::vector<Quat> estimate_orientations(const InsSensor& sensor, std::span<const double> time,
                                        const FilterOptions& options) {
  return run_filter(sensor, time, options).world_q_sensor;
}

}  // namespace kinfer
