// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/option_tree.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "kinfer/io/text/replace_all.hpp"

namespace kinfer::fuzz {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

/// The option of a line ".B \-o, \-\-out CSV"; without a name for a positional argument.
FuzzedOption parse_option(std::string line) {
  replace_all(line, "\\-", "-");
  FuzzedOption option;
  const std::size_t name = line.rfind("--");
  if (name == std::string::npos) return option;
  const std::size_t end = std::min(line.find(' ', name), line.size());
  option.name = line.substr(name, end - name);
  if (end < line.size()) option.placeholder = line.substr(end + 1);
  if (option.placeholder.find('|') != std::string::npos) option.choices = split(option.placeholder, '|');
  return option;
}

FuzzedVerb read_page(const std::filesystem::path& page, std::string name) {
  FuzzedVerb verb{.name = std::move(name), .options = {}};
  std::ifstream file(page);
  bool begins_entry = false, is_in_options = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(".SH")) is_in_options = line == ".SH OPTIONS";
    if (begins_entry && is_in_options && line.starts_with(".B "))
      if (FuzzedOption option = parse_option(line); !option.name.empty() && option.name != "--help")
        verb.options.push_back(std::move(option));
    begins_entry = line == ".TP";
  }
  return verb;
}

}  // namespace

std::vector<FuzzedVerb> read_option_tree(const std::filesystem::path& folder) {
  constexpr std::string_view prefix = "kinfer-", suffix = ".1";
  std::vector<FuzzedVerb> verbs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix))
      verbs.push_back(read_page(entry.path(), name.substr(prefix.size(), name.size() - prefix.size() - suffix.size())));
  }
  std::ranges::sort(verbs, {}, &FuzzedVerb::name);  // the order of a folder's entries is not that of every machine
  return verbs;
}

}  // namespace kinfer::fuzz
