// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/fleet/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

constexpr std::size_t dots_on_paper = 1000;  // of each series; more only cover each other

/// At most `dots_on_paper` of a sorted list, with both ends.
std::vector<double> thinned(const std::vector<double>& sorted) {
  if (sorted.size() <= dots_on_paper) return sorted;
  std::vector<double> some;
  for (std::size_t i = 0; i < dots_on_paper; ++i) some.push_back(sorted[i * (sorted.size() - 1) / (dots_on_paper - 1)]);
  return some;
}

std::vector<double> sorted_figures(const Fleet& fleet, std::string_view name) {
  std::vector<double> values;
  for (const FleetRow& row : fleet.rows)
    for (const SummaryFigure& figure : row.summary.figures)
      if (figure.name == name && figure.value > 0.0 && std::isfinite(figure.value)) values.push_back(mm * figure.value);
  std::ranges::sort(values);
  return thinned(values);
}

std::vector<double> shares(std::size_t n) {
  std::vector<double> x;
  for (std::size_t i = 0; i < n; ++i) x.push_back(100.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
  return x;
}

/// The first figure that some row has.
std::vector<double> first_of(const Fleet& fleet, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (auto values = sorted_figures(fleet, name); !values.empty()) return values;
  return {};
}

}  // namespace

std::string error_drawing(const Fleet& fleet) {
  const std::vector<double> after = first_of(fleet, {"rms_after_m", "rms_after_rad", "rms_m"}),
                            before = first_of(fleet, {"rms_before_m", "rms_before_rad"});
  if (after.size() < 2) return "";
  const bool is_angle = sorted_figures(fleet, "rms_after_m").empty() && sorted_figures(fleet, "rms_m").empty();
  std::vector<double> all = after;
  all.insert(all.end(), before.begin(), before.end());
  svg::Plot plot({.label = "tasks [%]", .low = 0.0, .high = 100.0},
                 svg::log_axis_for(is_angle ? "rms error [mrad]" : "rms error [mm]", all));
  if (!before.empty()) plot.cloud(shares(before.size()), before, 2.4, "fill-before");
  plot.cloud(shares(after.size()), after, 2.4, "fill-after");
  return plot.svg("Errors of all tasks, sorted");
}

std::string parameter_drawing(const Fleet& fleet) {
  constexpr std::size_t most = 40;
  constexpr double edge = 8.0;  // standard deviations at the edge of the strip
  std::map<std::string, const FleetSpread*> spreads;
  for (const FleetSpread& spread : fleet.spreads)
    if (!spread.logarithmic && spread.count >= 3 && spread.sd > 0.0) spreads[spread.name] = &spread;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> values;
  for (const FleetRow& row : fleet.rows)
    for (const SummaryParameter& p : row.summary.parameters) {
      const auto spread = spreads.find(p.name);
      if (spread == spreads.end()) continue;
      if (!values.contains(p.name) && names.size() < most) names.push_back(p.name);
      values[p.name].push_back(std::clamp((p.value - spread->second->median) / spread->second->sd, -edge, edge));
    }
  if (names.empty()) return "";
  const auto lines = static_cast<double>(names.size());
  svg::Plot plot({.label = "distance from the fleet's median [robust sd]", .low = -edge - 3.0, .high = edge},
                 {.label = "", .low = 0.0, .high = lines, .numbers = svg::AxisNumbers::hidden},
                 {.width = 720.0, .height = 60.0 + 16.0 * lines});
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<double>& list = values[names[i]];
    std::ranges::sort(list);
    const std::vector<double> shown = thinned(list);
    const double y = lines - static_cast<double>(i) - 0.5;
    plot.cloud(shown, std::vector<double>(shown.size(), y), 2.0, "fill-after");
    plot.words(-edge - 2.8, y, "tick", names[i]);
  }
  return plot.svg("Every robot's parameters against the fleet's");
}

}  // namespace kinfer::report
