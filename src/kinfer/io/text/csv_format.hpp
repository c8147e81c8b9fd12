// SPDX-License-Identifier: Apache-2.0
// How a table is written as text.
#pragma once

#include <string>
#include <vector>

namespace kinfer {

constexpr char automatic = '\0';  ///< delimiter or decimal mark as the text tells
constexpr char blanks = ' ';      ///< delimiter: runs of blanks and tabs

enum class HeaderLine { first, with_word, none };

struct CsvFormat {
  char delimiter = ',';
  char decimal = '.';
  int skip_lines = 0;                          ///< before the header
  std::vector<std::string> comments{};         ///< lines that begin with one of these are skipped, as those with #
  HeaderLine header_line = HeaderLine::first;  ///< none: the columns are named #1, #2 ...
  std::string header_word{};                   ///< of HeaderLine::with_word: the first line that contains it
};

}  // namespace kinfer
