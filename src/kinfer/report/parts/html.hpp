// SPDX-License-Identifier: Apache-2.0
// HTML building blocks: escaped text, rounded numbers, tables whose cells keep the exact value for CSV.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinfer::report::html {

std::string escape(std::string_view text);

/// Escaped; a number does not break from its unit, and kinfer commands are set as code.
std::string prose(std::string_view text);

/// A rounded number; "–" if it is not finite.
std::string fixed(double value, int decimals);

/// About three significant digits without an exponent: 0.395, 12.3, 3735.
std::string short_number(double value);

/// A table cell. `exact` is copied to CSV; if empty, the shown text is.
enum class CellKind { text, number, name };
struct Cell {
  std::string shown;  ///< HTML
  std::string exact{};
  CellKind kind = CellKind::text;
};
Cell text(std::string_view words);
Cell number(double value, int decimals);                 ///< unscaled
Cell number(double value, double factor, int decimals);  ///< factor · value, in the unit of the column header
Cell undetermined_cell(std::string_view words);

struct Table {
  std::string name;     ///< name of the CSV and id of the element
  std::string caption;  ///< description of the content
  std::vector<std::string> head;
  std::vector<std::vector<Cell>> rows;
  std::size_t long_after = 40;  ///< longer tables are folded on screens
};
std::string table(const Table& table);

/// A figure with title, drawing and caption; empty if there is no drawing.
std::string figure(std::string_view id, std::string_view title, std::string_view drawing, std::string_view words);

/// A section of the report.
struct Section {
  std::string id, title, lead, body;
};
std::string section(const Section& section);

/// CSS class of each mark and its meaning.
std::string legend(const std::vector<std::pair<const char*, const char*>>& kind_and_meaning);

std::string list(const std::vector<std::string>& items, std::string_view kind = "");

}  // namespace kinfer::report::html
