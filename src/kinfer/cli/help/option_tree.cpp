// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/option_tree.hpp"

#include <CLI/CLI.hpp>

namespace kinfer::cli {
namespace {

/// "TEXT:{a,b}" of CLI11: the type's name and the values that are allowed.
void read_type(const std::string& type, OptionEntry& option) {
  const std::size_t brace = type.find('{');
  option.placeholder = type.substr(0, type.find(':'));
  if (brace == std::string::npos) return;
  const std::string inside = type.substr(brace + 1, type.rfind('}') - brace - 1);
  for (std::size_t at = 0; at <= inside.size();) {
    const std::size_t end = std::min(inside.find(',', at), inside.size());
    option.choices.push_back(inside.substr(at, end - at));
    at = end + 1;
  }
}

OptionEntry option_entry(const CLI::Option& option) {
  OptionEntry entry{.names = {},
                    .position = {},
                    .placeholder = {},
                    .help = option.get_description(),
                    .default_value = option.get_default_str(),
                    .choices = {},
                    .group = option.get_group(),
                    .required = option.get_required(),
                    .repeats = option.get_items_expected_max() > 1};
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (option.get_positional() && entry.names.empty()) entry.position = option.get_name();
  if (option.get_items_expected_max() > 0) read_type(option.get_type_name(), entry);
  return entry;
}

}  // namespace

const VerbEntry* ProgramEntry::find(const std::string& verb) const {
  for (const VerbEntry& entry : verbs)
    if (entry.name == verb) return &entry;
  return nullptr;
}

VerbEntry verb_entry(const CLI::App& verb) {
  std::string footer = verb.get_footer();
  footer.erase(0, footer.find_first_not_of('\n'));
  VerbEntry entry{.name = verb.get_parent() ? verb.get_name() : "",
                  .summary = verb.get_description(),
                  .footer = footer,
                  .options = {}};
  for (const CLI::Option* option : verb.get_options()) entry.options.push_back(option_entry(*option));
  return entry;
}

ProgramEntry option_tree(const CLI::App& program) {
  ProgramEntry tree{.program = verb_entry(program), .verbs = {}};
  for (const CLI::App* verb : program.get_subcommands({}))
    if (!verb->get_group().empty()) tree.verbs.push_back(verb_entry(*verb));
  return tree;
}

}  // namespace kinfer::cli
