// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/machine_facts_toml.hpp"

#include <algorithm>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

double read_length_factor(TableReader& file, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return 1.0;
  TableReader units(*table, file.line_of("units"), "units: ", first_error);
  const auto unit = find_unit(units.text_or("length", "m"));
  if (!unit || unit->dimension != Dimension::length)
    units.report_error(units.line_of("length"), fmt::format("length: expected {}", describe(Dimension::length)));
  units.expect_no_other_keys();
  return unit ? unit->factor : 1.0;
}

double read_positive(TableReader& table, std::string_view key, double unit) {
  const double value = table.number(key);
  if (!(value > 0.0) && table.has(key))
    table.report_error(table.line_of(key), fmt::format("\"{}\": expected a positive number", key));
  table.expect_possible(key, unit * value, possible::length);
  return unit * value;
}

Vec3 read_point(TableReader& table, double unit) {
  Vec3 point = unit * table.vector("xyz");
  for (const double value : point) table.expect_possible("xyz", value, possible::length);
  return point;
}

/// begin, end, begin, end ... [s]
std::vector<HoldSegment> read_windows(TableReader& table, std::size_t least) {
  std::vector<HoldSegment> all;
  const std::vector<double> times = table.number_list("at");
  bool good = times.size() % 2 == 0 && times.size() >= 2 * least;
  for (std::size_t i = 0; i + 1 < times.size(); i += 2) {
    good = good && times[i] < times[i + 1];
    all.push_back({times[i], times[i + 1]});
    for (const double time : {times[i], times[i + 1]})
      table.expect_possible("at", time, possible_range(Dimension::time));
  }
  if (!good && table.has("at"))
    table.report_error(table.line_of("at"),
                       fmt::format("\"at\": expected begin, end of {} time window{} [s], each end after its begin",
                                   least == 1 ? "a" : "two or more", least == 1 ? "" : "s"));
  return all;
}

HoldSegment read_window(TableReader& table) {
  const auto all = read_windows(table, 1);
  if (all.size() > 1) table.report_error(table.line_of("at"), "\"at\": expected one time window");
  return all.empty() ? HoldSegment{} : all.front();
}

SegmentPoint read_place(TableReader& table, double unit) {
  SegmentPoint fact{.name = table.text("name"), .sensor = table.text("sensor"), .xyz = {}};
  if (!table.has("xyz")) return fact;
  fact.xyz = read_point(table, unit);
  fact.sigma = read_positive(table, "sigma", unit);
  return fact;
}

TouchMeasurement read_touch(TableReader& table, double unit) {
  return {table.text("point"), read_windows(table, 2), read_positive(table, "sigma", unit)};
}

TapeMeasurement read_tape(TableReader& table, double unit) {
  TapeMeasurement fact{table.text("from"),
                       table.text("to"),
                       read_positive(table, "length", unit),
                       read_positive(table, "sigma", unit),
                       {}};
  if (table.has("at")) fact.at = read_window(table);
  return fact;
}

SurveyMeasurement read_survey(TableReader& table, double unit) {
  return {table.text("point"), read_window(table), read_point(table, unit), read_positive(table, "sigma", unit)};
}

/// Reads every [[key]] table of the file with `read`.
template <class Fact>
std::vector<Fact> read_facts(TableReader& file, std::string_view key, double unit, FirstError& first_error,
                             Fact (*read)(TableReader&, double)) {
  std::vector<Fact> all;
  for (const auto& [table, line] : file.tables_or_none(key)) {
    TableReader reader(*table, line, fmt::format("{} {}: ", key, all.size() + 1), first_error);
    all.push_back(read(reader, unit));
    reader.expect_no_other_keys();
  }
  return all;
}

}  // namespace

Result<MachineMeasurements> parse_machine_facts(std::string_view text, const std::string& name) {
  KINFER_TRY(tree, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(tree, 1, "", first_error);
  const double unit = read_length_factor(file, first_error);
  MachineMeasurements all{read_facts(file, "place", unit, first_error, read_place),
                          read_facts(file, "touch", unit, first_error, read_touch),
                          read_facts(file, "tape", unit, first_error, read_tape),
                          read_facts(file, "point", unit, first_error, read_survey)};
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  if (all.empty()) return error("{}: expected [[touch]], [[tape]], [[point]] or [[place]]", name);
  return all;
}

Result<MachineMeasurements> read_machine_facts(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_machine_facts(text, path.filename().string());
}

}  // namespace kinfer
