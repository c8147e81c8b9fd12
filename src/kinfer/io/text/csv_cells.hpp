// SPDX-License-Identifier: Apache-2.0
// Lines and cells of tables as text: the inner loops of csv.
#pragma once

#include <algorithm>
#include <cstring>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/text/trim.hpp"

namespace kinfer {

constexpr char blanks = ' ';  ///< delimiter: runs of blanks and tabs

/// Which lines of a text count, and how far; empty: all.
struct LinePart {
  std::string_view only, end;
};

/// Iterates over the lines of a text, without line endings.
class LineReader {
 public:
  LineReader(std::string_view text, std::size_t at, int last_number, std::span<const std::string> comments = {},
             LinePart part = {})
      : text_(text), at_(at), number_(last_number), comments_(comments), part_(part) {}

  bool next() {
    if (at_ >= text_.size()) return false;
    const void* found = std::memchr(text_.data() + at_, '\n', text_.size() - at_);
    const std::size_t end = found ? static_cast<const char*>(found) - text_.data() : text_.size();
    line_ = text_.substr(at_, end - at_);
    before_ = at_;
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  /// The next line that is neither empty nor a comment.
  bool next_content_line() {
    while (next()) {
      if (!part_.only.empty() && line_.find(part_.only) == std::string_view::npos) continue;
      if (!part_.end.empty()) line_ = line_.substr(0, line_.find(part_.end));
      const auto first = line_.find_first_not_of(whitespace);
      if (first != std::string_view::npos && line_[first] != '#' && !is_comment(line_.substr(first))) return true;
    }
    return false;
  }

  std::string_view line() const { return line_; }
  int number() const { return number_; }
  std::size_t before() const { return before_; }
  std::size_t after() const { return std::min(at_, text_.size()); }

 private:
  bool is_comment(std::string_view line) const {
    return std::ranges::any_of(comments_, [&](const std::string& mark) { return line.starts_with(mark); });
  }

  std::string_view text_, line_;
  std::size_t at_, before_ = 0;
  int number_;
  std::span<const std::string> comments_;
  LinePart part_;
};

/// Splits one line; false where a quote is not closed.
class CellSplitter {
 public:
  CellSplitter(char delimiter, std::deque<std::string>& unquoted) : delimiter_(delimiter), unquoted_(unquoted) {}

  bool split(std::string_view line, std::vector<std::string_view>& cells) const {
    if (delimiter_ == blanks) return split_at_blanks(line, cells);
    std::size_t at = 0;
    while (true) {
      const auto first = line.find_first_not_of(delimiter_ == '\t' ? " " : " \t", at);
      if (first != std::string_view::npos && line[first] == '"') {
        const auto closed = read_quoted(line, first, cells);
        if (!closed) return false;
        at = *closed;
      } else {
        const auto end = std::min(line.find(delimiter_, at), line.size());
        cells.push_back(trim(line.substr(at, end - at)));
        at = end;
      }
      if (at >= line.size()) return true;
      ++at;  // skip the delimiter
    }
  }

 private:
  static bool split_at_blanks(std::string_view line, std::vector<std::string_view>& cells) {
    for (std::size_t at = line.find_first_not_of(whitespace); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(whitespace, at), line.size());
      cells.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(whitespace, end);
    }
    return true;
  }

  /// Reads the cell that opens with the quote at `open`; returns the offset of the delimiter after it.
  std::optional<std::size_t> read_quoted(std::string_view line, std::size_t open,
                                         std::vector<std::string_view>& cells) const {
    std::size_t at = open + 1;
    bool has_inner_quotes = false;
    while (true) {
      at = line.find('"', at);
      if (at == std::string_view::npos) return std::nullopt;
      if (at + 1 >= line.size() || line[at + 1] != '"') break;
      has_inner_quotes = true;
      at += 2;
    }
    std::string_view cell = line.substr(open + 1, at - open - 1);
    if (has_inner_quotes) cell = store_unquoted(cell);
    const auto end = std::min(line.find(delimiter_, at + 1), line.size());
    if (!trim(line.substr(at + 1, end - at - 1)).empty()) return std::nullopt;
    cells.push_back(trim(cell));
    return end;
  }

  std::string_view store_unquoted(std::string_view cell) const {
    std::string text;
    for (std::size_t i = 0; i < cell.size(); ++i) {
      text += cell[i];
      if (cell[i] == '"') ++i;  // doubled
    }
    return unquoted_.emplace_back(std::move(text));
  }

  char delimiter_;
  std::deque<std::string>& unquoted_;
};

}  // namespace kinfer
