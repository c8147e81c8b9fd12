// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/fleet_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "kinfer/io/text/csv_text.hpp"

namespace kinfer {
namespace {

std::string number_cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.10g}", value) : std::string();
}

std::string findings_cell(const std::vector<std::string>& kinds) {
  std::string text;
  for (const std::string& kind : kinds) text += (text.empty() ? "" : " ") + kind;
  return text;
}

}  // namespace

std::vector<FleetColumn> fleet_columns(const std::vector<FleetRow>& rows) {
  std::vector<FleetColumn> figures, parameters;
  std::set<std::string> known;
  for (const FleetRow& row : rows) {
    for (const SummaryFigure& figure : row.summary.figures)
      if (known.insert("figure " + figure.name).second) figures.push_back({.name = figure.name});
    for (const SummaryParameter& parameter : row.summary.parameters)
      if (known.insert("parameter " + parameter.name).second)
        parameters.push_back({.name = parameter.name, .is_parameter = true, .quantity = parameter.quantity});
  }
  figures.insert(figures.end(), parameters.begin(), parameters.end());
  return figures;
}

std::vector<ColumnValue> column_values(const FleetRow& row, const std::vector<FleetColumn>& columns) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::unordered_map<std::string, ColumnValue> figures, parameters;
  for (const auto& [name, value] : row.summary.figures) figures[name] = {value, none};
  for (const SummaryParameter& p : row.summary.parameters) parameters[p.name] = {p.value, p.sd};
  std::vector<ColumnValue> values;
  for (const FleetColumn& column : columns) {
    const auto& list = column.is_parameter ? parameters : figures;
    const auto at = list.find(column.name);
    values.push_back(at == list.end() ? ColumnValue{none, none} : at->second);
  }
  return values;
}

std::string format_fleet_table(const std::vector<FleetRow>& rows) {
  const std::vector<FleetColumn> columns = fleet_columns(rows);
  std::string text = "key,robot,date,verb,state,exit_code,usability,reason,deviation,most_deviant,findings,sentence";
  for (const FleetColumn& column : columns)
    text += column.is_parameter ? fmt::format(",{0}[{1}],sd_{0}[{1}]", column.name, unit(column.quantity))
                                : "," + column.name;
  text += "\n";
  for (const FleetRow& row : rows) {
    const bool is_done = row.state == TaskState::done;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", row.key, csv_cell(row.robot), csv_cell(row.date),
                        row.verb, name(row.state), is_done ? std::to_string(row.exit_code) : std::string(),
                        row.summary.usability ? name(*row.summary.usability) : std::string_view(), row.summary.reason,
                        row.deviation > 0.0 ? fmt::format("{:.3g}", row.deviation) : std::string(), row.most_deviant,
                        findings_cell(row.summary.findings), csv_cell(row.sentence));
    const auto values = column_values(row, columns);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      text += "," + number_cell(values[i].value);
      if (columns[i].is_parameter) text += "," + number_cell(values[i].sd);
    }
    text += "\n";
  }
  return text;
}

}  // namespace kinfer
