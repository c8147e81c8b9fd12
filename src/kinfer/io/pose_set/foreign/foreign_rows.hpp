// SPDX-License-Identifier: Apache-2.0
// Rows of cells as they stand in a foreign file: of any width, with their lines.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/text/csv.hpp"

namespace kinfer {

class ForeignRows {
 public:
  /// The rows of `text` from `at` on; `line`: number of the line before. Empty lines are left out, and those that begin
  /// with one of `comments` or #. A line whose quotes do not close becomes a row without cells.
  ForeignRows(std::string_view text, std::size_t at, int line, char delimiter, std::vector<std::string> comments = {});

  std::size_t rows() const { return line_.size(); }
  std::size_t width(std::size_t row) const { return begin_[row + 1] - begin_[row]; }
  int line(std::size_t row) const { return line_[row]; }
  /// Empty beyond the end of the row.
  std::string_view cell(std::size_t row, std::size_t column) const {
    return column < width(row) ? cells_[begin_[row] + column] : std::string_view();
  }
  /// Storage of cells that had quotes inside; the cells stay valid as long as what is returned.
  std::deque<std::string> take_unquoted() { return std::move(unquoted_); }

 private:
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> begin_{0};
  std::vector<int> line_;
  std::deque<std::string> unquoted_;
};

/// The next line of `text` from `at` on, without its end; `at` moves behind it.
std::string_view take_line(std::string_view text, std::size_t& at);

/// Cells of one line, trimmed.
std::vector<std::string> cells_of(std::string_view line, char delimiter);

}  // namespace kinfer
