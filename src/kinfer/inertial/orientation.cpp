#include "kinfer/inertial/orientation.hpp"

namespace kinfer {
namespace {

/// Runs a filter that streams. Rows before its first orientation are given that one.
template <class Filter>
std::vector<Quat> stream(const InsSensor& sensor, std::span<const double> time, Filter filter) {
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
  return stream(sensor, time, KinferFilter(options));
}

std::vector<Quat> run(const InsSensor& sensor, std::span<const double> time, const PaperEkfOptions& options) {
  return stream(sensor, time, PaperEkf(options));
}

void leave_field(KinferFilterOptions& options) {
  options.magnetometer = MagnetometerUse::off;
}
void leave_field(KinferOfflineOptions& options) {
  leave_field(options.filter);
}
void leave_field(PaperEkfOptions& options) {
  options.magnetometer = MagnetometerUse::off;
}

std::vector<Quat> run(const InsSensor& sensor, std::span<const double> time, const KinferOfflineOptions& options) {
  return smoothed_motion(sensor, time, options).world_q_sensor;
}

}  // namespace

std::optional<FilterOptions> filter_named(std::string_view name) {
  if (name == "kinfer") return KinferFilterOptions{};
  if (name == "kinfer-offline") return KinferOfflineOptions{};
  if (name == "paper") return PaperEkfOptions{};
  return std::nullopt;
}

FilterOptions without_magnetometer(FilterOptions options) {
  std::visit([](auto& chosen) { leave_field(chosen); }, options);
  return options;
}

std::vector<Quat> orientations(const InsSensor& sensor, std::span<const double> time, const FilterOptions& options) {
  return std::visit([&](const auto& chosen) { return run(sensor, time, chosen); }, options);
}

}  // namespace kinfer
