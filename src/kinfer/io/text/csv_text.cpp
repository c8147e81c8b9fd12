// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/csv_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include "kinfer/io/text/trim.hpp"

namespace kinfer {
namespace {

constexpr std::string_view formula_marks = "=+-@";

bool begins_formula(std::string_view text) {
  return !text.empty() && formula_marks.find(text.front()) != std::string_view::npos && !parse_number(text);
}

}  // namespace

std::string csv_cell(std::string_view text) {
  std::string cell = begins_formula(text) ? "'" : "";
  cell += text;
  std::ranges::replace_if(
      cell, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  const bool is_plain = cell.find_first_of(",;\"#") == std::string::npos && trim(cell).size() == cell.size();
  if (is_plain) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string_view without_formula_guard(std::string_view cell) {
  return cell.size() > 1 && cell.front() == '\'' && begins_formula(cell.substr(1)) ? cell.substr(1) : cell;
}

std::optional<double> parse_number(std::string_view cell, char decimal) {
  std::array<char, 64> copy;
  if (cell.empty() || cell.size() > copy.size()) return std::nullopt;
  std::size_t size = 0;
  for (const char c : cell) {
    if (c == '.' && decimal != '.') return std::nullopt;
    copy[size++] = c == decimal ? '.' : c;
  }
  const char* begin = copy.data() + (copy[0] == '+' && size > 1 && copy[1] != '-' ? 1 : 0);
  double value = 0.0;
  const auto [after, failure] = std::from_chars(begin, copy.data() + size, value);
  if (failure != std::errc() || after != copy.data() + size) return std::nullopt;
  return value;
}

}  // namespace kinfer
