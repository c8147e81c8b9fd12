// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/csv.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "kinfer/io/text/trim.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {
namespace {

constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

tl::unexpected<Error> unclosed_quote(const std::string& name, int line) {
  return error("{}:{}: a quoted cell does not end on this line, or text follows its closing quote", name, line);
}

/// The character that separates most columns of this line; blanks if none of , ; tab does.
char find_delimiter(std::string_view line, char decimal) {
  std::array<std::size_t, 3> counts{};
  constexpr std::string_view candidates = ";\t,";
  bool is_quoted = false;
  for (const char c : line) {
    is_quoted ^= c == '"';
    const auto at = candidates.find(c);
    if (!is_quoted && at != std::string_view::npos && c != decimal) ++counts[at];
  }
  const auto most = std::ranges::max_element(counts);
  return *most > 0 ? candidates[static_cast<std::size_t>(most - counts.begin())] : blanks;
}

/// A comma if cells of the first rows are numbers with decimal commas and none with points.
char find_decimal(std::string_view text, const CsvHeader& header, const CsvFormat& format) {
  constexpr int looked_at = 20;
  if (header.delimiter == ',') return '.';
  LineReader lines(text, header.body, header.line, format.comments, {format.only, format.end});
  std::deque<std::string> unquoted;
  bool has_comma = false;
  for (int row = 0; row < looked_at && lines.next_content_line(); ++row) {
    std::vector<std::string_view> cells;
    if (!CellSplitter(header.delimiter, unquoted).split(lines.line(), cells)) break;
    for (const std::string_view cell : cells) {
      if (cell.find('.') != std::string_view::npos && parse_number(cell, '.')) return '.';
      has_comma |= cell.find(',') != std::string_view::npos && parse_number(cell, ',').has_value();
    }
  }
  return has_comma ? ',' : '.';
}

/// Moves to the header's line, or before the first row where there is none.
bool find_header(LineReader& lines, const CsvFormat& format) {
  while (lines.next_content_line()) {
    if (format.header_line == HeaderLine::with_word && lines.line().find(format.header_word) == std::string_view::npos)
      continue;
    if (!lines.line().starts_with("sep=")) return true;  // a hint to spreadsheets
  }
  return false;
}

}  // namespace

bool is_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

std::string describe_column_count(const std::string& name, int line, std::size_t expected, std::size_t found,
                                  char delimiter) {
  std::string text = fmt::format("{}:{}: expected {} columns, found {}", name, line, expected, found);
  if (found > expected && delimiter == ',')
    text += "; are there commas inside numbers (thousands separators, decimal commas)?";
  return text;
}

Result<CsvHeader> read_csv_header(std::string_view text, const std::string& name, const CsvFormat& format) {
  if (is_utf16(text)) return error("{}:1: the file is UTF-16, expected UTF-8; save it as CSV UTF-8", name);
  LineReader lines(text, text.substr(0, 3) == utf8_byte_order_mark ? 3 : 0, 0, format.comments,
                   {format.only, format.end});
  for (int i = 0; i < format.skip_lines; ++i) lines.next();
  if (!find_header(lines, format))
    return format.header_line == HeaderLine::with_word
               ? error("{}: the file has no line with \"{}\", which begins the header", name, format.header_word)
               : error("{}: the file has no header line", name);
  CsvHeader header;
  header.line = lines.number();
  header.body = lines.after();
  header.delimiter = format.delimiter == automatic ? find_delimiter(lines.line(), format.decimal) : format.delimiter;
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  if (!CellSplitter(header.delimiter, unquoted).split(lines.line(), cells)) return unclosed_quote(name, header.line);
  header.columns.assign(cells.begin(), cells.end());
  if (header.delimiter != ',' && header.columns.size() > 1 && header.columns.back().empty() &&
      format.delimiter == automatic)
    header.columns.pop_back();  // a delimiter ends each line
  if (format.header_line == HeaderLine::none) {
    for (std::size_t c = 0; c < header.columns.size(); ++c) header.columns[c] = fmt::format("#{}", c + 1);
    header.line = lines.number() - 1;
    header.body = lines.before();
  }
  header.decimal = format.decimal == automatic ? find_decimal(text, header, format) : format.decimal;
  return header;
}

Result<void> expect_distinct_columns(const CsvHeader& header, const std::string& name) {
  std::set<std::string_view> seen;
  for (const std::string& column : header.columns) {
    const std::string_view plain = parse_column_header(column).name;
    if (plain.empty()) return error("{}:{}: a column has no name", name, header.line);
    if (!seen.insert(plain).second) return error("{}:{}: column {} appears twice", name, header.line, plain);
  }
  return {};
}

Result<CsvTable> split_csv(std::string_view text, const std::string& name, const CsvFormat& format) {
  CsvTable table;
  KINFER_TRY(header, read_csv_header(text, name, format));
  table.header = std::move(header);
  const std::size_t columns = table.header.columns.size();
  const CellSplitter splitter(table.header.delimiter, table.unquoted);
  LineReader lines(text, table.header.body, table.header.line, format.comments, {format.only, format.end});
  while (lines.next_content_line()) {
    const std::size_t before = table.cells.size();
    if (!splitter.split(lines.line(), table.cells)) return unclosed_quote(name, lines.number());
    if (table.cells.size() == before + columns + 1 && format.delimiter == automatic && table.header.delimiter != ',' &&
        table.cells.back().empty())
      table.cells.pop_back();
    const std::size_t found = table.cells.size() - before;
    if (found != columns)
      return forward_error({describe_column_count(name, lines.number(), columns, found, table.header.delimiter)});
    table.line.push_back(lines.number());
  }
  return table;
}

std::string describe_invalid_number(std::string_view column, std::string_view cell, char decimal) {
  std::string text = fmt::format("column {}: expected a number, found \"{}\"", column, cell);
  const bool digits_and_marks = cell.find_first_not_of("+-0123456789., '_") == std::string_view::npos;
  const bool has_point = cell.find('.') != std::string_view::npos, has_comma = cell.find(',') != std::string_view::npos;
  if (!digits_and_marks || cell.find_first_of("0123456789") == std::string_view::npos) return text;
  if (has_point && has_comma) return text + "; thousands separators are not read, or decimal marks are mixed";
  if (decimal == '.' && has_comma) return text + "; a column map can say decimal = \",\"";
  if (decimal == ',' && has_point) return text + "; the decimal mark of this file is the comma";
  return text + "; thousands separators are not read";
}

}  // namespace kinfer
