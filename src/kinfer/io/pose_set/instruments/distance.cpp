// SPDX-License-Identifier: Apache-2.0
// Column distance, with the number of an anchor (draw wire) or the name of a pair of rows (ball-bar) beside it.
#include <cmath>
#include <limits>

#include "kinfer/io/pose_set/measurement_columns.hpp"

namespace kinfer {
namespace {

/// `distance`: the distances not yet assigned to an anchor or a pair; set to NaN here once assigned.
void read_anchor_distances(PoseColumns& columns, RequiredContent required, NumberColumn& distance, PoseSet& set) {
  const auto anchor = columns.numbers("anchor", Dimension::one);
  if (!anchor) return;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const double number = (*anchor)[row];
    if (std::isnan(number)) continue;
    if (!(number >= 1 && number <= 1e6 && number == std::floor(number)))
      columns.report_error(row, fmt::format("column anchor: expected a whole number from 1, found {}", number));
    else if (std::isnan(distance[row]) && required == RequiredContent::measurements)
      columns.report_error(row, "column distance: the distance from the anchor is missing");
    else
      set.distances.push_back({static_cast<int>(row), static_cast<int>(number) - 1, distance[row]});
    distance[row] = std::numeric_limits<double>::quiet_NaN();
  }
}

void read_pairs(PoseColumns& columns, NumberColumn& distance, PoseSet& set) {
  const auto pairs = columns.name_indices("pair");
  if (!pairs) return;
  for (std::size_t k = 0; k < pairs->names.size(); ++k) {
    std::vector<int> rows;
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (pairs->index[row] == static_cast<int>(k)) rows.push_back(static_cast<int>(row));
    if (rows.size() != 2) {
      columns.report_error(rows.front(), fmt::format("column pair: expected 2 rows of pair \"{}\", found {}",
                                                     pairs->names[k], rows.size()));
      continue;
    }
    double &first = distance[rows[0]], &second = distance[rows[1]];
    if (std::isnan(first)) first = second;
    if (std::isnan(first)) columns.report_error(rows[0], "column distance: the distance of the pair is missing");
    if (!std::isnan(second) && first != second)
      columns.report_error(
          rows[1], fmt::format("column distance: the rows of pair \"{}\" give different distances", pairs->names[k]));
    set.pairs.push_back({rows[0], rows[1], first});
    first = second = std::numeric_limits<double>::quiet_NaN();
  }
}

void read_distances(PoseColumns& columns, const ReadContext& context, PoseSet& set) {
  auto distance = columns.numbers("distance", Dimension::length);
  NumberColumn none(columns.rows(), std::numeric_limits<double>::quiet_NaN());
  NumberColumn& given = distance ? *distance : none;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (given[row] < 0) columns.report_error(row, "column distance: expected a number from 0");
  read_anchor_distances(columns, context.required, given, set);
  read_pairs(columns, given, set);
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (!std::isnan(given[row])) columns.report_error(row, "column distance: expected an anchor or a pair beside it");
}

void write_distances(PoseSheet& sheet, const PoseSet& set) {
  if (set.distances.empty()) return;
  const std::size_t distance = sheet.column("distance" + sheet.in_lengths()), anchor = sheet.column("anchor");
  for (const DistanceMeasurement& measured : set.distances) {
    sheet.set(anchor, measured.row, fmt::format("{}", measured.anchor + 1));
    sheet.set(distance, measured.row, measured.distance, sheet.length());
  }
}

void write_pairs(PoseSheet& sheet, const PoseSet& set) {
  if (set.pairs.empty()) return;
  const std::size_t distance = sheet.column("distance" + sheet.in_lengths()), pair = sheet.column("pair");
  for (std::size_t i = 0; i < set.pairs.size(); ++i)
    for (const int row : {set.pairs[i].row, set.pairs[i].other}) {
      sheet.set(pair, row, fmt::format("{}", i + 1));
      sheet.set(distance, row, set.pairs[i].distance, sheet.length());
    }
}

}  // namespace

template <>
MeasurementColumns measurement_columns<DistanceMeasurement>() {
  return {read_distances, write_distances};
}

/// Read by the draw wires, which share the column.
template <>
MeasurementColumns measurement_columns<PairDistance>() {
  return {nullptr, write_pairs};
}

}  // namespace kinfer
