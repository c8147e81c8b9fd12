// Small words of HTML: escaped text, numbers as people read them, tables whose cells keep the exact value for CSV.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinfer::html {

std::string escape(std::string_view text);

/// Escaped; a number stays on the line of its unit, and calls of kinfer are set as code.
std::string prose(std::string_view text);

/// A number of table or sentence, rounded for reading; "–" where it is not finite.
std::string fixed(double value, int decimals);

/// About three significant digits without an exponent: 0.395, 12.3, 3735.
std::string short_number(double value);

/// A table cell. `exact` goes into the copied CSV; empty: the shown text does.
struct Cell {
  std::string shown;  ///< HTML
  std::string exact{};
  std::string kind{};  ///< CSS class: "num", "name", "weak"
};
Cell text(std::string_view words);
Cell number(double value, int decimals);                 ///< as it is
Cell number(double value, double factor, int decimals);  ///< factor · value, in the unit of the column's head
Cell undetermined(std::string_view words);

struct Table {
  std::string name;     ///< of the CSV, and the element's id
  std::string caption;  ///< what it shows, in words
  std::vector<std::string> head;
  std::vector<std::vector<Cell>> rows;
  std::size_t long_after = 40;  ///< rows from which on the table folds on screens
};
std::string table(const Table& table);

/// A figure with its title, what it shows in words, and a drawing; nothing where there is no drawing.
std::string figure(std::string_view id, std::string_view title, std::string_view drawing, std::string_view words);

/// A numbered chapter of the report.
struct Section {
  std::string id, title, lead, body;
};
std::string section(const Section& section);

std::string list(const std::vector<std::string>& items, std::string_view kind = "");

}  // namespace kinfer::html
