// SPDX-License-Identifier: Apache-2.0
// table.csv of a fleet: one row a key; figures and parameters in columns.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer {

/// A figure or parameter of some rows, in the order of the table: figures as they come, then parameters by joint.
struct FleetColumn {
  std::string name{};
  bool is_parameter = false;
  Quantity quantity = Quantity::length;  ///< of a parameter
};
std::vector<FleetColumn> fleet_columns(const std::vector<FleetRow>& rows);

/// The values of a row, in the order of `columns`; NaN where it has none. Parameters: value and standard deviation.
struct ColumnValue {
  double value, sd;
};
std::vector<ColumnValue> column_values(const FleetRow& row, const std::vector<FleetColumn>& columns);

/// SI, ten significant digits; an empty cell where a row has no such number.
std::string format_fleet_table(const std::vector<FleetRow>& rows);

}  // namespace kinfer
