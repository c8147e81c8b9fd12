// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/filters/orientation.hpp"

namespace kinfer {
namespace {

/// Runs an online filter. Rows before its first orientation get that one.
template <class Filter>
std::vector<Quat> run_online(const InsSensor& sensor, std::span<const double> time, Filter filter) {
  std::vector<Quat> out(time.size());
  std::size_t first = time.size();
  for (std::size_t row = 0; row < time.size(); ++row) {
    filter.add(sample(sensor, time, row));
    if (first == time.size() && filter.started()) first = row;
    out[row] = filter.orientation().normalized();
  }
  for (std::size_t row = 0; row < first && first < time.size(); ++row) out[row] = out[first];
  return out;
}

std::vector<Quat> run(const InsSensor& sensor, std::span<const double> time, const KinferFilterOptions& options) {
  return run_online(sensor, time, KinferFilter(options));
}

std::vector<Quat> run(const InsSensor& sensor, std::span<const double> time, const PaperEkfOptions& options) {
  return run_online(sensor, time, PaperEkf(options));
}

void disable_magnetometer(KinferFilterOptions& options) {
  options.magnetometer = MagnetometerUse::off;
}
void disable_magnetometer(KinferOfflineOptions& options) {
  disable_magnetometer(options.filter);
}
void disable_magnetometer(PaperEkfOptions& options) {
  options.magnetometer = MagnetometerUse::off;
}

std::vector<Quat> run(const InsSensor& sensor, std::span<const double> time, const KinferOfflineOptions& options) {
  return smooth_orientation(sensor, time, options).world_q_sensor;
}

}  // namespace

std::optional<FilterOptions> filter_named(std::string_view name) {
  if (name == "kinfer") return KinferFilterOptions{};
  if (name == "kinfer-offline") return KinferOfflineOptions{};
  if (name == "paper") return PaperEkfOptions{};
  return std::nullopt;
}

std::string_view filter_name(const FilterOptions& options) {
  if (std::holds_alternative<KinferFilterOptions>(options)) return "kinfer";
  return std::holds_alternative<PaperEkfOptions>(options) ? "paper" : "kinfer-offline";
}

FilterOptions without_magnetometer(FilterOptions options) {
  std::visit([](auto& chosen) { disable_magnetometer(chosen); }, options);
  return options;
}

std::vector<Quat> estimate_orientations(const InsSensor& sensor, std::span<const double> time,
                                        const FilterOptions& options) {
  return std::visit([&](const auto& chosen) { return run(sensor, time, chosen); }, options);
}

}  // namespace kinfer
