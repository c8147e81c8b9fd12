// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/fleet/table_data.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/io/fleet/fleet_table.hpp"
#include "kinfer/words/fleet/fleet.hpp"

namespace kinfer::report {
namespace {

/// Display unit of a figure by the end of its name.
struct FigureUnit {
  double factor = 1.0;
  const char* unit = "";
};

FigureUnit figure_unit(const std::string& name) {
  if (name.ends_with("_m")) return {1e3, " [mm]"};
  if (name.ends_with("_rad")) return {1e3, " [mrad]"};
  return {};
}

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("null");
}

std::string json_text(const std::string& text) {
  return nlohmann::ordered_json(text).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

std::string fleet_table_data(const Fleet& fleet) {
  std::vector<FleetColumn> columns = fleet_columns(fleet.rows);
  std::erase_if(columns, [](const FleetColumn& column) { return column.is_parameter; });
  std::string json = R"({"kind":"fleet","head":["key","robot","date","verb","status","deviation [sd]","of")";
  for (const FleetColumn& column : columns)
    json += "," + json_text(words::figure_name(column.name) + figure_unit(column.name).unit);
  json += ",\"sentence\"],\"rows\":[";
  bool is_first = true;
  for (const int i : worst_first(fleet)) {
    const FleetRow& row = fleet.rows[static_cast<std::size_t>(i)];
    json += fmt::format("{}[{},{},{},{},{},{},{}", is_first ? "" : ",\n", json_text(row.key), json_text(row.robot),
                        json_text(row.date), json_text(row.verb), json_text(std::string(status_name(row))),
                        json_number(row.deviation > 0.0 ? row.deviation : NAN), json_text(row.most_deviant));
    const auto values = column_values(row, columns);
    for (std::size_t k = 0; k < columns.size(); ++k)
      json += "," + json_number(figure_unit(columns[k].name).factor * values[k].value);
    json += "," + json_text(row.sentence) + "]";
    is_first = false;
  }
  return json + "]}";
}

}  // namespace kinfer::report
