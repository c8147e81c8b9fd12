// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/usage_error.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

namespace kinfer::cli {
namespace {

/// The verb, or the program where no verb was chosen.
const CLI::App& chosen_command(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? program : *chosen.front();
}

/// "--name" or "--name=", which gives nothing.
bool is_last_or_empty(const std::string& name, const std::vector<std::string>& arguments) {
  return std::ranges::any_of(arguments, [&](const std::string& a) { return a == name || a == name + "="; });
}

/// An option that got too many values or none, or a flag that got one.
std::optional<std::string> wrong_count(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    const auto most = static_cast<std::size_t>(std::max(0, option->get_items_expected_max()));
    if (most == 0) {
      const auto with_value = [&](const std::string& a) { return a.starts_with(name + "="); };
      if (std::ranges::any_of(arguments, with_value)) return fmt::format("{}: takes no value", name);
    } else if (option->count() > most) {
      return fmt::format("{}: given {} times, expected {}", name, option->count(),
                         most == 1 ? "once" : fmt::format("{} times at most", most));
    } else if (option->count() == 0 && is_last_or_empty(name, arguments)) {
      const std::string type = option->get_type_name();
      return fmt::format("{}: expected {} after it, found none", name, type.substr(0, type.find(':')));
    }
  }
  return std::nullopt;
}

}  // namespace

std::string usage_sentence(const CLI::ParseError& refusal, const CLI::App& program,
                           const std::vector<std::string>& arguments) {
  const CLI::App& command = chosen_command(program);
  if (dynamic_cast<const CLI::ExtrasError*>(&refusal) != nullptr) {
    const auto left = program.remaining(true);
    if (!left.empty()) return fmt::format("{}: expected nothing like \"{}\" here", command.get_name(), left.front());
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&refusal) != nullptr)
    if (auto sentence = wrong_count(command, arguments)) return *sentence;
  if (dynamic_cast<const CLI::RequiredError*>(&refusal) != nullptr && &command == &program) return "expected a verb";
  return refusal.what();
}

}  // namespace kinfer::cli
