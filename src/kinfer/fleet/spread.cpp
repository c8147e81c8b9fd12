// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/spread.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinfer/fleet/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/geometry/student.hpp"

namespace kinfer::fleet {
namespace {

struct Sample {
  std::size_t row;
  double value;     ///< logarithm of a figure, parameter as it is
  double sd = 0.0;  ///< of a parameter
};

/// Of one number, over the rows that have it.
struct Series {
  bool logarithmic = false;
  std::vector<Sample> samples{};
};

using SeriesByName = std::map<std::pair<std::string, std::string>, Series>;  // verb and name

bool is_error(const std::string& name) {
  return name.starts_with("rms") || name.starts_with("max") || name.starts_with("worst") || name.starts_with("sigma");
}

SeriesByName collect_series(const std::vector<FleetRow>& rows) {
  SeriesByName all;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const TaskSummary& summary = rows[row].summary;
    for (const auto& [name, value] : summary.figures) {
      if (!is_error(name) || !(value > 0.0) || !std::isfinite(value)) continue;
      Series& series = all[{rows[row].verb, name}];
      series.logarithmic = true;
      series.samples.push_back({row, std::log(value)});
    }
    for (const SummaryParameter& parameter : summary.parameters)
      if (std::isfinite(parameter.value))
        all[{rows[row].verb, parameter.name}].samples.push_back({row, parameter.value, parameter.sd});
  }
  return all;
}

FleetSpread spread_of(const std::pair<std::string, std::string>& verb_and_name, const Series& series) {
  std::vector<double> values;
  for (const Sample& sample : series.samples) values.push_back(sample.value);
  return {.verb = verb_and_name.first,
          .name = verb_and_name.second,
          .logarithmic = series.logarithmic,
          .median = median(values),
          .sd = robust_sd(values),
          .count = static_cast<int>(values.size())};
}

int degrees_of_freedom(int rows) {
  return std::max(1, static_cast<int>(thresholds::robust_efficiency * (rows - 1)));
}

}  // namespace

void compare_rows(Fleet& fleet) {
  const SeriesByName all = collect_series(fleet.rows);
  std::vector<FleetDeviation> candidates;
  double comparisons = 0.0;
  for (const auto& [verb_and_name, series] : all) {
    const FleetSpread spread = spread_of(verb_and_name, series);
    fleet.spreads.push_back(spread);
    if (spread.count < thresholds::smallest_fleet || !(spread.sd > 0.0)) continue;
    for (const Sample& sample : series.samples) {
      comparisons += 1.0;
      const double sigmas = gaussian_of_student((sample.value - spread.median) / std::hypot(spread.sd, sample.sd),
                                                degrees_of_freedom(spread.count));
      FleetRow& row = fleet.rows[sample.row];
      if (std::abs(sigmas) > row.deviation) row.deviation = std::abs(sigmas), row.most_deviant = spread.name;
      if (std::abs(sigmas) < 3.0) continue;  // far below any limit, and most of the rows
      const bool is_log = spread.logarithmic;
      candidates.push_back({row.key, spread.name, is_log ? std::exp(sample.value) : sample.value,
                            is_log ? std::exp(spread.median) : spread.median, sigmas});
    }
  }
  const double limit = std::max(3.0, normal_quantile(1.0 - 0.5 * thresholds::fleet_risk / std::max(1.0, comparisons)));
  for (FleetDeviation& deviation : candidates)
    if (std::abs(deviation.sigmas) > limit) fleet.deviations.push_back(std::move(deviation));
  std::ranges::stable_sort(fleet.deviations, [](const FleetDeviation& a, const FleetDeviation& b) {
    return std::abs(a.sigmas) > std::abs(b.sigmas);
  });
}

}  // namespace kinfer::fleet
