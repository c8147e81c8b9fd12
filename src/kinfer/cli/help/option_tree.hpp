// SPDX-License-Identifier: Apache-2.0
// The program's verbs and options as values: what help texts, man pages and completions are made of.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kinfer::cli {

struct OptionEntry {
  std::vector<std::string> names;    ///< "-o", "--out"; of a positional argument: none
  std::string position;              ///< name of a positional argument
  std::string placeholder;           ///< what stands for the value: "CSV", "N"; empty for a flag
  std::string help, default_value;   ///< empty: no default
  std::vector<std::string> choices;  ///< the only values; empty: any
  std::string group;                 ///< heading under which the help lists it
  bool required = false, repeats = false;

  bool is_flag() const { return placeholder.empty() && position.empty(); }
};

struct VerbEntry {
  std::string name;  ///< empty: the program itself
  std::string summary, footer;
  std::vector<OptionEntry> options;
};

struct ProgramEntry {
  VerbEntry program;
  std::vector<VerbEntry> verbs;

  const VerbEntry* find(const std::string& verb) const;  ///< null where there is none
};

ProgramEntry option_tree(const CLI::App& program);
VerbEntry verb_entry(const CLI::App& verb);

}  // namespace kinfer::cli
