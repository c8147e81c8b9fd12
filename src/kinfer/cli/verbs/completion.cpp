// SPDX-License-Identifier: Apache-2.0
// kinfer completion and kinfer man: what shells and man(1) know of the program, made of its options.
#include "kinfer/cli/help/completion.hpp"

#include <memory>

#include "kinfer/base/version.hpp"
#include "kinfer/cli/help/man_page.hpp"
#include "kinfer/cli/parts/output_folder.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

struct ManArguments {
  std::string verb, out;
};

int print_completion(const CLI::App& app, const std::string& shell) {
  const ProgramEntry program = option_tree(app);
  print_data(shell == "bash"  ? bash_completion(program)
             : shell == "zsh" ? zsh_completion(program)
                              : fish_completion(program));
  return exit_done;
}

int write_man_pages(const ProgramEntry& program, const std::string& out) {
  auto folder = OutputFolder::make(out);
  if (!folder) return fail(folder.error());
  auto done = write_text_file(*folder / "kinfer.1", man_page(program, version));
  for (const VerbEntry& verb : program.verbs)
    if (done) done = write_text_file(*folder / ("kinfer-" + verb.name + ".1"), man_page(verb, version));
  if (done) done = folder->commit();
  return done ? exit_done : fail(done.error());
}

int print_man_page(const CLI::App& app, const ManArguments& options) {
  const ProgramEntry program = option_tree(app);
  if (!options.out.empty()) return write_man_pages(program, options.out);
  if (options.verb.empty()) {
    print_data(man_page(program, version));
    return exit_done;
  }
  const VerbEntry* verb = program.find(options.verb);
  if (!verb) return fail({fmt::format("there is no verb \"{}\"", options.verb)});
  print_data(man_page(*verb, version));
  return exit_done;
}

}  // namespace

Verb add_completion(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "completion", "Completion script of a shell, to standard output",
                  "Example:\n  kinfer completion bash > ~/.local/share/bash-completion/completions/kinfer");
  auto shell = std::make_shared<std::string>();
  add_choice(*verb, "shell", *shell, {"bash", "zsh", "fish"}, "Which shell", Requirement::required);
  return {verb, [&app, shell] { return print_completion(app, *shell); }};
}

Verb add_man(CLI::App& app) {
  CLI::App* verb = add_command(app, "man", "Man page of the program or of a verb, to standard output",
                               "Examples:\n  kinfer man calibrate | man -l -\n  kinfer man --out man1");
  auto options = std::make_shared<ManArguments>();
  add_text(*verb, "verb", options->verb, "The verb; none: the program", Requirement::optional, "VERB");
  add_text(*verb, "--out", options->out, "Write the pages of the program and of all verbs into this folder instead",
           Requirement::optional, "DIR");
  return {verb, [&app, options] { return print_man_page(app, *options); }};
}

}  // namespace kinfer::cli
