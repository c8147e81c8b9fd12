// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/help_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinfer::cli {
namespace {

constexpr std::size_t help_column = 26;

/// Words from `column` on, on lines of `width` columns, the first of which begins at `at`.
std::string wrapped(const std::string& text, std::size_t at, std::size_t column, std::size_t width) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (at > column && at + 1 + word.size() > width) {
      result += "\n" + std::string(column, ' ');
      at = column;
    } else if (at > column) {
      result += " ";
      ++at;
    }
    result += word;
    at += word.size();
    begin = end + 1;
  }
  return result;
}

std::string option_lines(const OptionEntry& option, std::size_t width) {
  const std::string usage = "  " + option_usage(option);
  std::string help = option.help;
  if (!option.default_value.empty()) help += fmt::format(" [{}]", option.default_value);
  const bool fits = usage.size() + 2 <= help_column;
  const std::string gap = fits ? std::string(help_column - usage.size(), ' ') : "\n" + std::string(help_column, ' ');
  return usage + gap + wrapped(help, help_column, help_column, width) + "\n";
}

/// A heading of the group of a positional or required option: these come first.
std::string group_of(const OptionEntry& option) {
  return option.required ? "Required" : option.group;
}

}  // namespace

std::string option_usage(const OptionEntry& option) {
  const std::string value =
      option.choices.empty() ? option.placeholder : fmt::format("{}", fmt::join(option.choices, "|"));
  const std::string name = option.position.empty() ? fmt::format("{}", fmt::join(option.names, ", ")) : option.position;
  return name + (value.empty() ? "" : " " + value) + (option.repeats ? "..." : "");
}

std::string usage_line(const VerbEntry& verb) {
  std::string line = "kinfer " + verb.name;
  for (const OptionEntry& option : verb.options) {
    if (!option.position.empty())
      line += fmt::format(" {}{}", option.placeholder, option.repeats ? "..." : "");
    else if (option.required)
      line += fmt::format(" {} {}", option.names.back(), option.placeholder);
  }
  return line + " [OPTIONS]";
}

std::vector<std::string> groups_of(const VerbEntry& verb) {
  std::vector<std::string> groups;
  const auto add = [&](const std::string& group) {
    if (std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
  };
  for (const OptionEntry& option : verb.options)
    if (option.required) add(group_of(option));
  for (const OptionEntry& option : verb.options)
    if (option.names.empty() || option.names.back() != "--help") add(group_of(option));
  return groups;
}

std::string help_text(const VerbEntry& verb, std::size_t width) {
  std::string text = fmt::format("{}\n\nUsage: {}\n", verb.summary, usage_line(verb));
  for (const std::string& group : groups_of(verb)) {
    text += fmt::format("\n{}:\n", group);
    for (const OptionEntry& option : verb.options)
      if (group_of(option) == group) text += option_lines(option, width);
  }
  return text + "\n" + verb.footer + "\n";
}

std::string help_text(const ProgramEntry& program, std::size_t width) {
  std::string text = fmt::format("{}\n\nUsage: kinfer VERB [OPTIONS]\n\nVerbs:\n", program.program.summary);
  for (const VerbEntry& verb : program.verbs)
    text +=
        fmt::format("  {:<{}}{}\n", verb.name, help_column - 2, wrapped(verb.summary, help_column, help_column, width));
  text += "\nOptions:\n";
  for (const OptionEntry& option : program.program.options) text += option_lines(option, width);
  return text + "\n" + program.program.footer + "\n";
}

}  // namespace kinfer::cli
