// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/help/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinfer::cli {
namespace {

std::vector<std::string> option_names(const VerbEntry& verb) {
  std::vector<std::string> names;
  for (const OptionEntry& option : verb.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> verb_names(const ProgramEntry& program) {
  std::vector<std::string> names;
  for (const VerbEntry& verb : program.verbs) names.push_back(verb.name);
  return names;
}

/// Values of the verbs' first arguments that are not files are in their help text only.
bool takes_folder(const OptionEntry& option) {
  return option.placeholder == "DIR";
}

/// Values that are neither files nor choices: numbers and names.
bool takes_file(const OptionEntry& option) {
  static const std::vector<std::string> kinds{"FILE", "CSV", "TOML", "DIR", "TEXT", "NAME|TOML", "GRADE"};
  return std::ranges::find(kinds, option.placeholder) != kinds.end();
}

std::string single_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// The first sentence, for one line beside the option.
std::string short_help(const OptionEntry& option) {
  return option.help.substr(0, std::min(option.help.find_first_of(".;:"), std::size_t{70}));
}

std::string bash_values(const VerbEntry& verb) {
  std::string text;
  for (const OptionEntry& option : verb.options) {
    if (option.is_flag() || option.names.empty()) continue;
    const std::string reply = !option.choices.empty()
                                  ? fmt::format("COMPREPLY=($(compgen -W {} -- \"$current\"))",
                                                single_quoted(fmt::format("{}", fmt::join(option.choices, " "))))
                              : takes_folder(option) ? "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$current\"))"
                              : takes_file(option)   ? "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$current\"))"
                                                     : "COMPREPLY=()";
    text += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), reply);
  }
  return text;
}

}  // namespace

std::string bash_completion(const ProgramEntry& program) {
  std::string text = fmt::format(
      "# bash completion of kinfer\n"
      "_kinfer() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} verb=${{COMP_WORDS[1]}}\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W {} -- \"$current\")); return\n"
      "  fi\n"
      "  case $verb in\n",
      single_quoted(
          fmt::format("{} {}", fmt::join(verb_names(program), " "), fmt::join(option_names(program.program), " "))));
  for (const VerbEntry& verb : program.verbs)
    text += fmt::format(
        "    {})\n      case $previous in\n{}      esac\n"
        "      [[ $current == -* ]] && COMPREPLY=($(compgen -W {} -- \"$current\")) && return ;;\n",
        verb.name, bash_values(verb), single_quoted(fmt::format("{}", fmt::join(option_names(verb), " "))));
  return text +
         "  esac\n  compopt -o filenames\n  COMPREPLY=($(compgen -f -- \"$current\"))\n}\ncomplete -F _kinfer kinfer\n";
}

std::string zsh_completion(const ProgramEntry& program) {
  const auto escaped = [](const std::string& text) {  // of _arguments: colons and brackets have a meaning
    std::string result;
    for (const char c : text) {
      if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
      result += c;
    }
    return result;
  };
  std::string text = "#compdef kinfer\n# zsh completion of kinfer\n_kinfer() {\n  local -a verbs\n  verbs=(\n";
  for (const VerbEntry& verb : program.verbs)
    text += fmt::format("    {}\n", single_quoted(verb.name + ":" + escaped(verb.summary)));
  text += "  )\n  if (( CURRENT == 2 )); then _describe verb verbs; return; fi\n  case $words[2] in\n";
  for (const VerbEntry& verb : program.verbs) {
    text += fmt::format("    {})\n      shift words; (( CURRENT-- ))\n      _arguments", verb.name);
    for (const OptionEntry& option : verb.options)
      for (const std::string& name : option.names) {
        const std::string values = !option.choices.empty() ? fmt::format(":value:({})", fmt::join(option.choices, " "))
                                   : option.is_flag()      ? ""
                                   : takes_folder(option)  ? ":folder:_files -/"
                                   : takes_file(option)    ? ":file:_files"
                                                           : ":" + escaped(option.placeholder) + ": ";
        text += " \\\n        " + single_quoted(fmt::format("{}[{}]{}", name, escaped(short_help(option)), values));
      }
    text += " \\\n        '*:file:_files' ;;\n";
  }
  return text + "  esac\n}\n_kinfer \"$@\"\n";
}

std::string fish_completion(const ProgramEntry& program) {
  std::string text = "# fish completion of kinfer\n";
  for (const VerbEntry& verb : program.verbs)
    text += fmt::format("complete -c kinfer -n __fish_use_subcommand -f -a {} -d {}\n", verb.name,
                        single_quoted(verb.summary));
  for (const VerbEntry& verb : program.verbs)
    for (const OptionEntry& option : verb.options) {
      if (option.names.empty()) continue;
      text += fmt::format("complete -c kinfer -n '__fish_seen_subcommand_from {}'", verb.name);
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.choices.empty())
        text += fmt::format(" -x -a {}", single_quoted(fmt::format("{}", fmt::join(option.choices, " "))));
      else if (!option.is_flag())
        text += takes_folder(option) ? " -x -a '(__fish_complete_directories)'" : takes_file(option) ? " -r -F" : " -x";
      text += " -d " + single_quoted(short_help(option)) + "\n";
    }
  return text;
}

}  // namespace kinfer::cli
