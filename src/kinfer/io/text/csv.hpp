// SPDX-License-Identifier: Apache-2.0
// Tables as text: one header line, then rows of cells. Comments (#) and empty lines are skipped; CRLF, a UTF-8
// byte-order mark and quoted cells are supported. Delimiter and decimal mark may be told from the text.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/text/csv_cells.hpp"
#include "kinfer/io/text/csv_text.hpp"

namespace kinfer {

constexpr char automatic = '\0';  ///< delimiter or decimal mark as the text tells

enum class HeaderLine { first, with_word, none };

struct CsvFormat {
  char delimiter = ',';
  char decimal = '.';
  int skip_lines = 0;                          ///< before the header
  std::vector<std::string> comments{};         ///< lines that begin with one of these are skipped, as those with #
  std::string only{};                          ///< lines that do not hold this text are skipped; empty: none
  std::string end{};                           ///< a line is read up to this text; empty: all of it
  HeaderLine header_line = HeaderLine::first;  ///< none: the columns are named #1, #2 ...
  std::string header_word{};                   ///< of HeaderLine::with_word: the first line that contains it
};

struct CsvHeader {
  std::vector<std::string> columns;
  int line = 0;                         ///< from 1
  std::size_t body = 0;                 ///< offset in the text of the line after the header
  char delimiter = ',', decimal = '.';  ///< as found, where they were automatic
};

/// By its byte order mark: no reader takes it, and each says so.
bool is_utf16(std::string_view text);

/// "poses.csv:3: expected 9 columns, found 8", and what commas inside numbers have to do with it.
std::string describe_column_count(const std::string& name, int line, std::size_t expected, std::size_t found,
                                  char delimiter);

/// The first line that is neither empty nor a comment. A missing header and UTF-16 are errors.
Result<CsvHeader> read_csv_header(std::string_view text, const std::string& name_in_messages,
                                  const CsvFormat& format = {});

/// An error unless every column has a name and all names differ (units ignored).
Result<void> expect_distinct_columns(const CsvHeader& header, const std::string& name_in_messages);

/// The cells are views into the text that was split, which must outlive the table.
struct CsvTable {
  CsvHeader header;
  std::vector<std::string_view> cells;  ///< row after row, trimmed
  std::vector<int> line;                ///< of each row, from 1
  std::deque<std::string> unquoted;     ///< cells that had quotes inside

  std::size_t rows() const { return line.size(); }
  std::string_view cell(std::size_t row, std::size_t column) const {
    return cells[row * header.columns.size() + column];
  }
};
Result<CsvTable> split_csv(std::string_view text, const std::string& name_in_messages, const CsvFormat& format = {});

/// `column q3: expected a number, found "1.234,5"`, with a hint where the decimal mark or thousands separators are the
/// cause.
std::string describe_invalid_number(std::string_view column, std::string_view cell, char decimal);

}  // namespace kinfer
