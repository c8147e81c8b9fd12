// SPDX-License-Identifier: Apache-2.0
// Command-line options of a verb: a thin wrapper around CLI11, whose header costs ten seconds per including file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kinfer::cli {

enum class Requirement { optional, required };

/// A verb of the program with its help text; `footer` shows an example.
CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& summary,
                      const std::string& footer);

/// Options that are added from now on are listed under this heading.
void begin_group(CLI::App& verb, const std::string& heading);

// Each binds `value`, which must outlive the run of the verb; its current content is the default shown in the help.
void add_text(CLI::App& verb, const std::string& name, std::string& value, const std::string& help,
              Requirement need = Requirement::optional, const std::string& placeholder = "TEXT");
void add_texts(CLI::App& verb, const std::string& name, std::vector<std::string>& values, const std::string& help,
               Requirement need = Requirement::optional, const std::string& placeholder = "TEXT");
/// What is given for this option ("--chain") is replaced when the arguments are parsed.
void replace_text(CLI::App& verb, const std::string& option,
                  const std::function<std::string(const std::string&)>& replacement);
/// One value each time the option is given.
void add_list(CLI::App& verb, const std::string& name, std::vector<std::string>& values, const std::string& help,
              const std::string& placeholder);
void add_choice(CLI::App& verb, const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                const std::string& help, Requirement need = Requirement::optional);
void add_count(CLI::App& verb, const std::string& name, int& value, int lowest, int highest, const std::string& help);
/// A count without default.
void add_count(CLI::App& verb, const std::string& name, std::optional<int>& value, int lowest, int highest,
               const std::string& help);
/// Every number has limits: what lies outside them, nan and the infinities are refused when the arguments are parsed.
void add_number(CLI::App& verb, const std::string& name, double& value, double lowest, double highest,
                const std::string& help);
/// A number without default; `given` tells whether the option was used.
void add_number(CLI::App& verb, const std::string& name, double& value, bool& given, double lowest, double highest,
                const std::string& help);
void add_seed(CLI::App& verb, const std::string& name, std::uint64_t& value, const std::string& help);
void add_flag(CLI::App& verb, const std::string& name, bool& value, const std::string& help);

bool was_chosen(const CLI::App& verb);

/// Whether the program has this verb, and whether the verb has this option ("--seed").
bool has_verb(const CLI::App& program, const std::string& verb);
bool has_option(const CLI::App& program, const std::string& verb, const std::string& option);

/// Whether the user gave this option of the verb ("--method").
bool was_given(const CLI::App& verb, const std::string& option);

}  // namespace kinfer::cli
