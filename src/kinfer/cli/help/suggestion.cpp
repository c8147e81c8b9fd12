// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer::cli {
namespace {

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const auto nearest = nearest_word(word, known);
  return nearest ? fmt::format("; did you mean {}?", *nearest) : "";
}

std::vector<std::string> long_and_short_names(const VerbEntry& verb) {
  std::vector<std::string> names;
  for (const OptionEntry& option : verb.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

const OptionEntry* find_option(const VerbEntry& verb, const std::string& name) {
  for (const OptionEntry& option : verb.options)
    if (std::ranges::find(option.names, name) != option.names.end()) return &option;
  return nullptr;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const auto rows = static_cast<int>(a.size()), columns = static_cast<int>(b.size());
  std::vector<std::vector<int>> d(rows + 1, std::vector<int>(columns + 1));
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[rows][columns];
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::optional<std::string> best;
  int least = 0;
  for (const std::string& candidate : known) {
    const bool begins_with = word.size() >= 3 && candidate.starts_with(word);
    const int distance = begins_with ? 1 : edit_distance(word, candidate);
    if (distance > std::max(1, static_cast<int>(candidate.size()) / 3) || (best && distance >= least)) continue;
    best = candidate, least = distance;
  }
  return best;
}

std::optional<std::string> misspelling(const std::vector<std::string>& arguments, const ProgramEntry& program) {
  const VerbEntry* verb = nullptr;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const bool is_option = argument.starts_with("--") && argument.size() > 2;
    if (!is_option && !verb && !argument.starts_with("-")) {
      verb = program.find(argument);
      if (verb) continue;
      std::vector<std::string> verbs;
      for (const VerbEntry& known : program.verbs) verbs.push_back(known.name);
      return fmt::format("there is no verb \"{}\"{}", argument, did_you_mean(argument, verbs));
    }
    if (!is_option) continue;
    const VerbEntry& owner = verb ? *verb : program.program;
    const std::string name = argument.substr(0, argument.find('='));
    const OptionEntry* option = find_option(owner, name);
    if (!option)
      return fmt::format("{}there is no option {}{}", verb ? verb->name + ": " : "", name,
                         did_you_mean(name, long_and_short_names(owner)));
    if (!option->is_flag() && name == argument) ++i;  // its value, which may look like an option
  }
  return std::nullopt;
}

}  // namespace kinfer::cli
