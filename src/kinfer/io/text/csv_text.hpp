// SPDX-License-Identifier: Apache-2.0
// Single cells of a table: names and other texts as they are written and come back, numbers as they are read.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinfer {

/// Quoted where it holds a delimiter, a quote, a line break or a comment mark. A text that a spreadsheet would run as a
/// formula (it begins with = + - @ or a tab, and is no number) gets an apostrophe in front, as spreadsheets write it.
/// Control characters, which a table of lines cannot hold, become blanks.
std::string csv_cell(std::string_view text);

/// The text of a cell that was read: without the apostrophe of csv_cell.
std::string_view without_formula_guard(std::string_view cell);

/// The whole cell as a number ("nan" and "inf" included); empty where it is not a number.
std::optional<double> parse_number(std::string_view cell, char decimal = '.');

}  // namespace kinfer
