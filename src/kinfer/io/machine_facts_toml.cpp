#include "kinfer/io/machine_facts_toml.hpp"

#include <algorithm>

#include "kinfer/io/text_file.hpp"
#include "kinfer/io/toml_tree.hpp"
#include "kinfer/io/units.hpp"

namespace kinfer {
namespace {

double length_unit(TableReader& file, Complaint& complaint) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return 1.0;
  TableReader units(*table, file.line_of("units"), "units: ", complaint);
  const auto unit = find_unit(units.text_or("length", "m"));
  if (!unit || unit->dimension != Dimension::length)
    units.complain(units.line_of("length"), fmt::format("length: expected {}", describe(Dimension::length)));
  units.expect_no_other_keys();
  return unit ? unit->factor : 1.0;
}

double positive(TableReader& table, std::string_view key, double unit) {
  const double value = table.number(key);
  if (!(value > 0.0) && table.has(key))
    table.complain(table.line_of(key), fmt::format("\"{}\": expected a positive number", key));
  return unit * value;
}

/// begin, end, begin, end ... [s]
std::vector<HoldWindow> windows(TableReader& table, std::size_t least) {
  std::vector<HoldWindow> all;
  const std::vector<double> times = table.number_list("at");
  bool good = times.size() % 2 == 0 && times.size() >= 2 * least;
  for (std::size_t i = 0; i + 1 < times.size(); i += 2) {
    good = good && times[i] < times[i + 1];
    all.push_back({times[i], times[i + 1]});
  }
  if (!good && table.has("at"))
    table.complain(table.line_of("at"),
                   fmt::format("\"at\": expected begin, end of {} time window{} [s], each end after its begin",
                               least == 1 ? "a" : "two or more", least == 1 ? "" : "s"));
  return all;
}

HoldWindow window(TableReader& table) {
  const auto all = windows(table, 1);
  if (all.size() > 1) table.complain(table.line_of("at"), "\"at\": expected one time window");
  return all.empty() ? HoldWindow{} : all.front();
}

PlaceFact place(TableReader& table, double unit) {
  PlaceFact fact{.name = table.text("name"), .sensor = table.text("sensor"), .xyz = {}};
  if (!table.has("xyz")) return fact;
  fact.xyz = unit * table.vector("xyz");
  fact.sigma = positive(table, "sigma", unit);
  return fact;
}

TouchFact touch(TableReader& table, double unit) {
  return {table.text("point"), windows(table, 2), positive(table, "sigma", unit)};
}

TapeFact tape(TableReader& table, double unit) {
  TapeFact fact{
      table.text("from"), table.text("to"), positive(table, "length", unit), positive(table, "sigma", unit), {}};
  if (table.has("at")) fact.at = window(table);
  return fact;
}

SurveyFact survey(TableReader& table, double unit) {
  return {table.text("point"), window(table), unit * table.vector("xyz"), positive(table, "sigma", unit)};
}

/// Every [[key]] of the file by `read`.
template <class Fact>
std::vector<Fact> facts(TableReader& file, std::string_view key, double unit, Complaint& complaint,
                        Fact (*read)(TableReader&, double)) {
  std::vector<Fact> all;
  for (const auto& [table, line] : file.tables_or_none(key)) {
    TableReader reader(*table, line, fmt::format("{} {}: ", key, all.size() + 1), complaint);
    all.push_back(read(reader, unit));
    reader.expect_no_other_keys();
  }
  return all;
}

}  // namespace

Result<MachineFacts> parse_machine_facts(std::string_view text, const std::string& name) {
  KINFER_TRY(tree, parse_toml(text, name));
  Complaint complaint(name);
  TableReader file(tree, 1, "", complaint);
  const double unit = length_unit(file, complaint);
  MachineFacts all{facts(file, "place", unit, complaint, place), facts(file, "touch", unit, complaint, touch),
                   facts(file, "tape", unit, complaint, tape), facts(file, "point", unit, complaint, survey)};
  file.expect_no_other_keys();
  if (complaint.any()) return pass_on(complaint.as_error());
  if (all.empty()) return error("{}: expected [[touch]], [[tape]], [[point]] or [[place]]", name);
  return all;
}

Result<MachineFacts> read_machine_facts(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_machine_facts(text, path.filename().string());
}

}  // namespace kinfer
