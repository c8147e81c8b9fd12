// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/manifest.hpp"

#include <glob.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "kinfer/base/sha256.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/replace_all.hpp"

namespace kinfer {
namespace {

constexpr std::size_t longest_key = 120;

bool is_key(std::string_view key) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  // A leading point is that of unfinished tasks.
  return !key.empty() && key.size() <= longest_key && key.front() != '.' &&
         key.find_first_not_of(allowed) == std::string_view::npos;
}

bool is_file_of_sweep(std::string_view key) {
  return key == manifest_name || (key.starts_with(archive_begin) && key.ends_with(archive_end));
}

Result<void> check_key(const std::string& key) {
  if (is_file_of_sweep(key)) return error("the key \"{}\" is the name of a file of the sweep itself", key);
  if (is_key(key)) return {};
  return error("the key \"{}\" cannot name a folder; expected up to {} letters, digits, \".\", \"-\" and \"_\"", key,
               longest_key);
}

std::string quoted_word(const std::string& word) {
  const bool is_plain = !word.empty() && word.find_first_of(" \t\"'") == std::string::npos;
  if (is_plain) return word;
  if (word.find('"') == std::string::npos) return "\"" + word + "\"";
  if (word.find('\'') == std::string::npos) return "'" + word + "'";
  std::string pieces;  // side by side they are one word
  for (const char c : word) pieces += c == '"' ? "'\"'" : fmt::format("\"{}\"", c);
  return pieces;
}

std::string quoted_cell(const std::string& cell) {
  if (cell.find_first_of(",\"#") == std::string::npos) return cell;
  std::string text = cell;
  replace_all(text, "\"", "\"\"");
  return "\"" + text + "\"";
}

constexpr std::array<std::pair<const char*, std::string SweepTask::*>, 3> optional_columns{
    {{"robot", &SweepTask::robot}, {"date", &SweepTask::date}, {"truth", &SweepTask::truth}}};

/// Such dates are in the order of time where they are in the order of the alphabet.
bool is_date(const std::string& text) {
  constexpr std::string_view form = "0000-00-00";
  for (std::size_t i = 0; i < form.size(); ++i)
    if (i >= text.size() || (form[i] == '0' ? text[i] < '0' || text[i] > '9' : text[i] != form[i])) return false;
  return text.size() == form.size() || text[form.size()] == 'T' || text[form.size()] == ' ';
}

/// What the wildcards of `pattern` matched in `path`, joined by "_": each part of a path between two slashes that has
/// wildcards counts as a whole, without what stands before the first and behind the last of them.
std::string wildcard_key(const std::string& pattern, const std::string& path) {
  std::string key;
  std::string_view left_pattern = pattern, left_path = path;
  const auto next_part = [](std::string_view& left) {
    const std::size_t end = std::min(left.find('/'), left.size());
    const std::string_view part = left.substr(0, end);
    left.remove_prefix(std::min(end + 1, left.size()));
    return part;
  };
  while (!left_pattern.empty() && !left_path.empty()) {
    const std::string_view wild = next_part(left_pattern), part = next_part(left_path);
    const std::size_t first = wild.find_first_of("*?["), last = wild.find_last_of("*?]");
    if (first == std::string_view::npos) continue;
    const std::size_t behind = wild.size() - last - 1;
    if (first + behind > part.size()) continue;
    key += (key.empty() ? "" : "_") + std::string(part.substr(first, part.size() - first - behind));
  }
  return key;
}

}  // namespace

Result<std::vector<std::string>> split_words(std::string_view text) {
  std::vector<std::string> words;
  std::optional<std::string> word;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote)
        quote = '\0';
      else
        word->push_back(c);
    } else if (c == '"' || c == '\'') {
      quote = c;
      if (!word) word.emplace();
    } else if (c == ' ' || c == '\t') {
      if (word) words.push_back(*std::exchange(word, std::nullopt));
    } else {
      if (!word) word.emplace();
      word->push_back(c);
    }
  }
  if (quote != '\0') return error("a quoted argument does not end: {}", text);
  if (word) words.push_back(*word);
  return words;
}

namespace {

/// No program can be given a zero byte, and a manifest that is written again would lose others.
bool has_control_character(const std::string& word) {
  return std::ranges::any_of(word, [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
}

}  // namespace

Result<std::vector<SweepTask>> parse_manifest(std::string_view text, const std::string& name) {
  KINFER_TRY(table, split_csv(text, name));
  std::map<std::string, std::size_t> columns;
  for (std::size_t i = 0; i < table.header.columns.size(); ++i) columns[table.header.columns[i]] = i;
  for (const char* needed : {"key", "verb", "arguments"})
    if (!columns.contains(needed))
      return error("{}:{}: expected the columns key, verb and arguments; {} is missing", name, table.header.line,
                   needed);
  std::vector<SweepTask> tasks;
  std::map<std::string, int> line_of;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    SweepTask task{.key = std::string(table.cell(row, columns["key"])),
                   .verb = std::string(table.cell(row, columns["verb"])),
                   .arguments = {},
                   .line = table.line[row]};
    auto words = split_words(table.cell(row, columns["arguments"]));
    if (!words) return error("{}:{}: {}", name, task.line, words.error().what);
    if (std::ranges::any_of(*words, has_control_character))
      return error("{}:{}: the arguments hold a control character", name, task.line);
    task.arguments = std::move(*words);
    for (const auto& [column, member] : optional_columns)
      if (columns.contains(column)) task.*member = std::string(table.cell(row, columns[column]));
    if (auto checked = check_key(task.key); !checked) return error("{}:{}: {}", name, task.line, checked.error().what);
    if (!task.date.empty() && !is_date(task.date))
      return error("{}:{}: the date \"{}\": expected YYYY-MM-DD, or with a time behind it", name, task.line, task.date);
    if (const auto [other, is_new] = line_of.emplace(task.key, task.line); !is_new)
      return error("{}:{}: the key \"{}\" stands in line {} too", name, task.line, task.key, other->second);
    tasks.push_back(std::move(task));
  }
  if (tasks.empty()) return error("{}: the manifest has no tasks", name);
  return tasks;
}

Result<std::vector<SweepTask>> read_manifest(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_manifest(text, path.string());
}

std::string format_manifest(const std::vector<SweepTask>& tasks) {
  std::string text = "key,verb,arguments";
  std::vector<std::string SweepTask::*> more;
  for (const auto& column : optional_columns)
    if (std::ranges::any_of(tasks, [&](const SweepTask& task) { return !(task.*column.second).empty(); }))
      text += fmt::format(",{}", column.first), more.push_back(column.second);
  text += "\n";
  for (const SweepTask& task : tasks) {
    std::string arguments;
    for (const std::string& word : task.arguments) arguments += (arguments.empty() ? "" : " ") + quoted_word(word);
    text += fmt::format("{},{},{}", task.key, quoted_cell(task.verb), quoted_cell(arguments));
    for (const auto member : more) text += "," + quoted_cell(task.*member);
    text += "\n";
  }
  return text;
}

Result<std::vector<SweepTask>> tasks_of_files(const std::string& pattern, const std::string& verb,
                                              const std::string& arguments) {
  if (pattern.find_first_of("*?[") == std::string::npos)
    return error("--each {}: expected a pattern with *, ? or [ ]", pattern);
  KINFER_TRY(words, split_words(arguments));
  glob_t found{};
  const int state = ::glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> files(found.gl_pathv, found.gl_pathv + (state == 0 ? found.gl_pathc : 0));
  ::globfree(&found);
  if (files.empty()) return error("--each {}: no file matches", pattern);
  std::vector<SweepTask> tasks;
  std::set<std::string> keys;
  for (const std::string& file : files) {
    SweepTask task{.key = wildcard_key(pattern, file), .verb = verb, .arguments = words};
    if (auto checked = check_key(task.key); !checked) return error("{}: {}", file, checked.error().what);
    if (!keys.insert(task.key).second)
      return error("--each {}: the key \"{}\" stands for several files", pattern, task.key);
    const std::string folder = std::filesystem::path(file).parent_path().string();
    for (std::string& word : task.arguments) {
      replace_all(word, "{file}", file);
      replace_all(word, "{folder}", folder.empty() ? "." : folder);
    }
    tasks.push_back(std::move(task));
  }
  return tasks;
}

std::uint64_t task_seed(std::uint64_t sweep_seed, std::string_view key) {
  const std::string digest = sha256(fmt::format("{}/{}", sweep_seed, key));
  std::uint64_t seed = 0;
  std::from_chars(digest.data(), digest.data() + 16, seed, 16);
  return seed;
}

}  // namespace kinfer
