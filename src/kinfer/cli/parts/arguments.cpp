// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/arguments.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

namespace kinfer::cli {
namespace {

/// CLI11's own range lets nan pass, and states limits with six decimals. Without a description help lines stay short.
CLI::Validator in_range(double lowest, double highest) {
  const auto complaint = [lowest, highest](const std::string& text) -> std::string {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && value >= lowest && value <= highest) return {};
    return fmt::format("expected a number from {:g} to {:g}, found \"{}\"", lowest, highest, text);
  };
  return CLI::Validator(complaint, "");
}

CLI::Validator whole_in_range(int lowest, int highest) {
  const auto complaint = [lowest, highest](const std::string& text) -> std::string {
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code == std::errc() && end == text.data() + text.size() && value >= lowest && value <= highest) return {};
    return fmt::format("expected a whole number from {} to {}, found \"{}\"", lowest, highest, text);
  };
  return CLI::Validator(complaint, "");
}

/// Its description is how the help and the shells' completions know the choices.
CLI::Validator one_of(const std::vector<std::string>& allowed) {
  const auto complaint = [allowed](const std::string& text) -> std::string {
    if (std::ranges::find(allowed, text) != allowed.end()) return {};
    return fmt::format("expected one of {}, found \"{}\"", fmt::join(allowed, ", "), text);
  };
  return CLI::Validator(complaint, fmt::format("{{{}}}", fmt::join(allowed, ",")));
}

}  // namespace

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& summary,
                      const std::string& footer) {
  CLI::App* verb = program.add_subcommand(name, summary);
  verb->set_help_flag("-h,--help", "Print this help")->group("Output and repeatability");
  verb->footer(footer);
  return verb;
}

void begin_group(CLI::App& verb, const std::string& heading) {
  verb.option_defaults()->group(heading);
}

void add_text(CLI::App& verb, const std::string& name, std::string& value, const std::string& help, Requirement need,
              const std::string& placeholder) {
  CLI::Option* option = verb.add_option(name, value, help)->type_name(placeholder);
  if (need == Requirement::required)
    option->required();
  else if (!value.empty())
    option->capture_default_str();
}

void add_texts(CLI::App& verb, const std::string& name, std::vector<std::string>& values, const std::string& help,
               Requirement need, const std::string& placeholder) {
  CLI::Option* option = verb.add_option(name, values, help)->type_name(placeholder);
  if (need == Requirement::required) option->required();
}

void replace_text(CLI::App& verb, const std::string& option,
                  const std::function<std::string(const std::string&)>& replacement) {
  const auto replace = [replacement](std::string& text) {
    text = replacement(text);
    return std::string();
  };
  verb.get_option(option)->transform(CLI::Validator(replace, ""));
}

void add_list(CLI::App& verb, const std::string& name, std::vector<std::string>& values, const std::string& help,
              const std::string& placeholder) {
  verb.add_option(name, values, help)->type_name(placeholder)->allow_extra_args(false);
}

void add_choice(CLI::App& verb, const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                const std::string& help, Requirement need) {
  CLI::Option* option = verb.add_option(name, value, help)->check(one_of(allowed));
  if (need == Requirement::required)
    option->required();
  else
    option->capture_default_str();
}

void add_count(CLI::App& verb, const std::string& name, int& value, int lowest, int highest, const std::string& help) {
  verb.add_option(name, value, help)->type_name("N")->check(whole_in_range(lowest, highest))->capture_default_str();
}

void add_count(CLI::App& verb, const std::string& name, std::optional<int>& value, int lowest, int highest,
               const std::string& help) {
  verb.add_option(name, value, help)->type_name("N")->check(whole_in_range(lowest, highest));
}

void add_number(CLI::App& verb, const std::string& name, double& value, double lowest, double highest,
                const std::string& help) {
  verb.add_option(name, value, help)->check(in_range(lowest, highest))->capture_default_str();
}

void add_number(CLI::App& verb, const std::string& name, double& value, bool& given, double lowest, double highest,
                const std::string& help) {
  verb.add_option(name, value, help)->check(in_range(lowest, highest))->each([&given](const std::string&) {
    given = true;
  });
}

void add_seed(CLI::App& verb, const std::string& name, std::uint64_t& value, const std::string& help) {
  // CLI11 wraps what is negative or too large around.
  const auto expect_seed = [](const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), seed);
    const bool is_seed = code == std::errc() && end == text.data() + text.size();
    return is_seed ? std::string() : "expected a whole number from 0 to 18446744073709551615, found \"" + text + "\"";
  };
  verb.add_option(name, value, help)->check(expect_seed)->capture_default_str();
}

void add_flag(CLI::App& verb, const std::string& name, bool& value, const std::string& help) {
  verb.add_flag(name, value, help)->disable_flag_override();
}

bool was_chosen(const CLI::App& verb) {
  return verb.parsed();
}

bool was_given(const CLI::App& verb, const std::string& option) {
  return verb.count(option) > 0;
}

namespace {

const CLI::App* find_verb(const CLI::App& program, const std::string& verb) {
  const auto found = program.get_subcommands([&](const CLI::App* command) { return command->get_name() == verb; });
  return found.empty() ? nullptr : found.front();
}

}  // namespace

bool has_verb(const CLI::App& program, const std::string& verb) {
  return find_verb(program, verb) != nullptr;
}

bool has_option(const CLI::App& program, const std::string& verb, const std::string& option) {
  const CLI::App* command = find_verb(program, verb);
  return command != nullptr && command->get_option_no_throw(option) != nullptr;
}

}  // namespace kinfer::cli
