// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/monitoring.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "kinfer/fleet/control_chart.hpp"
#include "kinfer/fleet/thresholds.hpp"

namespace kinfer::fleet {
namespace {

struct DatedValue {
  const FleetRow* row = nullptr;
  double value = 0.0;
};

/// By robot, verb and name of the number; in the order of dates.
using DatedSeries = std::map<std::tuple<std::string, std::string, std::string>, std::vector<DatedValue>>;

DatedSeries dated_series(const std::vector<FleetRow>& rows) {
  std::vector<const FleetRow*> dated;
  for (const FleetRow& row : rows)
    if (!row.robot.empty() && !row.date.empty() && row.state == TaskState::done) dated.push_back(&row);
  std::ranges::stable_sort(dated, {}, &FleetRow::date);
  DatedSeries all;
  for (const FleetRow* row : dated) {
    for (const auto& [name, value] : row->summary.figures)
      if (row->verb == "verify" && name.starts_with("rms") && value > 0.0)
        all[{row->robot, row->verb, name}].push_back({row, std::log(value)});  // errors scatter by factors
    if (row->verb != "calibrate") continue;
    for (const SummaryParameter& parameter : row->summary.parameters)
      all[{row->robot, row->verb, parameter.name}].push_back({row, parameter.value});
  }
  std::erase_if(all, [](const auto& entry) { return entry.second.size() < thresholds::shortest_series; });
  return all;
}

}  // namespace

ControlChartSummary monitor(const std::vector<FleetRow>& rows) {
  const DatedSeries all = dated_series(rows);
  ControlChartSummary chart{.series = static_cast<int>(all.size())};
  for (const auto& [name, series] : all) chart.checks += static_cast<int>(series.size()) - 2;
  if (chart.series == 0) return chart;
  chart.limit = limit_for_run_length(chart.checks / thresholds::chart_risk);
  chart.run_length = average_run_length(chart.limit);
  chart.false_alarms = chart.checks / chart.run_length;
  for (const auto& [robot_verb_name, series] : all) {
    std::vector<double> values;
    for (const DatedValue& dated : series) values.push_back(dated.value);
    const auto alarm = cusum_alarm(standardised_innovations(values), chart.limit);
    if (!alarm) continue;
    chart.alarms.push_back({.robot = std::get<0>(robot_verb_name),
                            .name = std::get<2>(robot_verb_name),
                            .since = series[change_point(values, alarm->noticed)].row->date,
                            .noticed = series[alarm->noticed].row->date,
                            .key = series[alarm->noticed].row->key,
                            .rises = alarm->rises,
                            .statistic = alarm->statistic,
                            .limit = chart.limit});
  }
  return chart;
}

}  // namespace kinfer::fleet
