// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/foreign/foreign_rows.hpp"

#include <algorithm>

namespace kinfer {

ForeignRows::ForeignRows(std::string_view text, std::size_t at, int line, char delimiter,
                         std::vector<std::string> comments) {
  LineReader lines(text, at, line, comments);
  const CellSplitter splitter(delimiter, unquoted_);
  while (lines.next_content_line()) {
    if (!splitter.split(lines.line(), cells_)) cells_.resize(begin_.back());
    begin_.push_back(cells_.size());
    line_.push_back(lines.number());
  }
}

std::string_view take_line(std::string_view text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  std::string_view line = text.substr(std::min(at, text.size()), end - std::min(at, end));
  at = std::min(end + 1, text.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::vector<std::string> cells_of(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  if (!CellSplitter(delimiter, unquoted).split(line, cells)) return {};
  return {cells.begin(), cells.end()};
}

}  // namespace kinfer
