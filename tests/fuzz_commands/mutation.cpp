// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/mutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <vector>

#include "fuzz_commands/material.hpp"

namespace kinfer::fuzz {
namespace {

constexpr const char* wild_numbers[] = {"nan",   "inf",   "-inf", "1e300",  "-1e300", "1e308",  "5e-324", "0",
                                        "-0",    "-1",    "1",    "2",      "1e-9",   "1e9",    "1e17",   "2147483648",
                                        "-1e-3", "0.001", "1e6",  "999999", "1e4",    "123456", "0.5",    "360"};
constexpr const char* wild_texts[] = {"",          " ",
                                      "\"",        "'",
                                      "a,b,c",     "\u00e4\u00f6\u2192",
                                      "=1+1",      "@cmd",
                                      "../..",     "/dev/null",
                                      "{out}",     "%s%n",
                                      "\x01\x02",  "\xff\xfe",
                                      "<a>&amp;",  "-",
                                      "--",        "base",
                                      "ins1",      "ins0=0deg@1s",
                                      "ins1-ins2", "no/such/file.csv",
                                      "1,2,3"};

std::string pick(std::span<const char* const> list, Rng& rng) {
  return list[rng.index(list.size())];
}

std::string draw_list(Rng& rng) {
  const std::uint64_t count = 1 + rng.index(7);
  std::string list;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i > 0) list += ",";
    list += rng.index(4) == 0 ? pick(wild_numbers, rng) : fmt::format("{}", static_cast<int>(rng.index(200)) - 100);
  }
  return list;
}

bool is_part_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
}

/// Replaces the number at or after a random place.
void change_number(std::string& text, Rng& rng) {
  std::size_t begin = text.find_first_of("0123456789", rng.index(text.size()));
  if (begin == std::string::npos) return;
  while (begin > 0 && is_part_of_number(text[begin - 1])) --begin;
  std::size_t end = begin;
  while (end < text.size() && is_part_of_number(text[end])) ++end;
  text.replace(begin, end - begin, pick(wild_numbers, rng));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Takes a line out, doubles it or swaps it with another.
void change_lines(std::string& text, Rng& rng) {
  std::vector<std::string> lines = lines_of(text);
  const std::size_t at = rng.index(lines.size()), other = rng.index(lines.size());
  const std::uint64_t what = rng.index(4);
  if (what == 0) lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
  if (what == 1) lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), std::string(lines[other]));
  if (what == 2) std::swap(lines[at], lines[other]);
  if (what == 3) lines.resize(at + 1);
  text.clear();
  for (const std::string& line : lines) text += line + "\n";
}

/// Sets, scales or empties one column of a table.
void change_column(std::string& text, Rng& rng) {
  std::vector<std::string> lines = lines_of(text);
  const std::uint64_t column = rng.index(8), what = rng.index(4);
  const std::string value = what == 0 ? "" : pick(wild_numbers, rng);
  for (std::size_t row = 1; row < lines.size(); ++row) {
    std::size_t begin = 0;
    for (std::uint64_t c = 0; c < column && begin != std::string::npos; ++c) begin = lines[row].find(',', begin + 1);
    if (begin == std::string::npos) return;
    begin += lines[row][begin] == ',' ? 1 : 0;
    const std::size_t end = std::min(lines[row].find(',', begin), lines[row].size());
    if (what == 1)
      lines[row].insert(end, "e3");  // as if the unit were another
    else
      lines[row].replace(begin, end - begin, value);
  }
  text.clear();
  for (const std::string& line : lines) text += line + "\n";
}

/// Replaces a word, as a name or a key is.
void change_word(std::string& text, Rng& rng) {
  const std::size_t begin = text.find_first_of("abcdefghijklmnopqrstuvwxyz", rng.index(text.size()));
  if (begin == std::string::npos) return;
  std::size_t end = begin;
  while (end < text.size() && ((text[end] >= 'a' && text[end] <= 'z') || text[end] == '_')) ++end;
  text.replace(begin, end - begin, pick(wild_texts, rng));
}

/// Replaces a byte, or puts a text before it.
void change_byte(std::string& text, bool replace, Rng& rng) {
  const std::size_t at = rng.index(text.size());
  if (replace)
    text[at] = static_cast<char>(rng.index(256));
  else
    text.insert(at, pick(wild_texts, rng));
}

}  // namespace

std::string draw_value(const FuzzedOption& option, Rng& rng) {
  if (!option.choices.empty() && rng.index(8) != 0) return option.choices[rng.index(option.choices.size())];
  const bool is_count = option.placeholder == "N";
  const bool is_number = is_count || option.placeholder == "FLOAT" || option.placeholder == "UINT";
  const std::uint64_t what = rng.index(10);
  if (is_number && what < 8)
    return what < 4 ? fmt::format("{}", static_cast<int>(rng.index(is_count ? 12 : 100)) - 1) : pick(wild_numbers, rng);
  const std::vector<std::string> files = files_for(option.placeholder);
  if (!files.empty() && what < 7) return files[rng.index(files.size())];
  if (option.placeholder == "LIST" || option.placeholder == "X,Y,Z")
    if (what < 8) return draw_list(rng);
  return rng.index(3) == 0 ? pick(wild_numbers, rng) : pick(wild_texts, rng);
}

std::string mutate(std::string text, Rng& rng) {
  for (std::uint64_t changes = 1 + rng.index(3); changes > 0 && !text.empty(); --changes) {
    const std::uint64_t what = rng.index(10);
    if (what < 5)
      change_number(text, rng);
    else if (what == 5)
      change_lines(text, rng);
    else if (what == 6)
      change_column(text, rng);
    else if (what == 7)
      change_word(text, rng);
    else
      change_byte(text, what == 8, rng);
  }
  return text;
}

}  // namespace kinfer::fuzz
