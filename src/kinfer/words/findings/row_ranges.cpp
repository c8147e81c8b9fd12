// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/row_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer::words {
namespace {

constexpr std::size_t most_ranges = 12;  // listed in a sentence

std::string row_range(int first, int last) {
  if (last == first) return fmt::format("{}", first);
  return last == first + 1 ? fmt::format("{}, {}", first, last) : fmt::format("{}-{}", first, last);
}

}  // namespace

std::string row_ranges(const std::vector<int>& rows) {
  std::vector<std::string> pieces;
  for (std::size_t i = 0; i < rows.size();) {
    std::size_t end = i;
    while (end + 1 < rows.size() && rows[end + 1] == rows[end] + 1) ++end;
    pieces.push_back(row_range(rows[i], rows[end]));
    i = end + 1;
  }
  std::string text = rows.size() == 1 ? "row " : "rows ";
  const std::size_t shown = std::min(most_ranges, pieces.size());
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? "" : i + 1 == shown && shown == pieces.size() ? " and " : ", ") + pieces[i];
  return shown == pieces.size() ? text : text + fmt::format(" and more, {} in all", rows.size());
}

}  // namespace kinfer::words
