// SPDX-License-Identifier: Apache-2.0
// The program: one file per verb; exit codes as documented in docs/formats.md.
#include <malloc.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/version.hpp"
#include "kinfer/cli/help/help_text.hpp"
#include "kinfer/cli/help/suggestion.hpp"
#include "kinfer/cli/help/usage_error.hpp"
#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/process.hpp"
#include "kinfer/cli/parts/program.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::cli {
namespace {

std::string formatted_help(const CLI::App* app, const std::string&, CLI::AppFormatMode) {
  return app->get_parent() ? help_text(verb_entry(*app), terminal_width())
                           : help_text(option_tree(*app), terminal_width());
}

/// Options before the verb.
struct ProgramOptions {
  std::string language = "english", kernels = "auto";
  double memory = 8.0;   ///< [GB]
  double time = 3600.0;  ///< [s]
};

/// Options and verbs of the program; `options` must outlive the parsing.
std::vector<Verb> describe_program(CLI::App& app, ProgramOptions& options) {
  app.formatter_fn(formatted_help);  // before the verbs, which inherit it
  app.set_version_flag("--version", std::string("kinfer ") + version, "Print the version");
  add_choice(app, "--language", options.language, {"english", "names"},
             "names: the stable name of each fact instead of its sentence, for programs and translators");
  add_number(app, "--limit-memory", options.memory, 0.0, 1e6,
             "Memory beyond which the program ends with a sentence [GB]; 0: any");
  add_number(app, "--limit-time", options.time, 0.0, 1e8,
             "Time after which it ends with a sentence [s]; 0: any; track and sweep have none");
  add_choice(app, "--kernels", options.kernels, {"auto", "portable", "avx2", "avx512"},
             "Instruction set of the numeric kernels; portable gives the same last digits on every x86-64 processor");
  app.require_subcommand(1);
  app.footer("`kinfer VERB --help` explains a verb and shows an example; `kinfer demo` shows what kinfer does.");
  return add_verbs(app);
}

int fail_usage(std::string_view sentence, const std::vector<std::string>& arguments, const ProgramEntry& program) {
  const bool has_verb = program.find(arguments.front()) != nullptr;
  print_message("kinfer: {}\n`kinfer{} --help` lists what there is.\n", sentence,
                has_verb ? " " + arguments.front() : "");
  return exit_bad_input;
}

std::string chosen_verb(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "" : chosen.front()->get_name();
}

}  // namespace

std::size_t terminal_width() {
  constexpr std::size_t narrowest = 60, usual = 100, widest = 120;
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return usual;
  return std::clamp<std::size_t>(size.ws_col, narrowest, widest);
}

struct Program::Description {
  CLI::App app{"kinfer: from raw measurements to a proven kinematic model", "kinfer"};
  ProgramOptions options{};
  std::vector<Verb> verbs = describe_program(app, options);
  ProgramEntry tree = option_tree(app);
};

Program::Program() : description_(std::make_unique<Description>()) {}
Program::~Program() = default;

int Program::run(const std::vector<std::string>& arguments) {
  store_command_line(arguments);
  auto& [app, options, verbs, program] = *description_;
  if (arguments.empty()) {
    print_message("{}", help_text(program, terminal_width()));
    return exit_bad_input;
  }
  if (const auto sentence = misspelling(arguments, program)) return fail_usage(*sentence, arguments, program);
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // CLI11 takes them from the back
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& parse_error) {
    if (parse_error.get_exit_code() != 0)
      return fail_usage(usage_sentence(parse_error, app, arguments), arguments, program);
    std::ostringstream out;
    app.exit(parse_error, out);  // --help and --version
    print_text("{}", out.str());
    return exit_done;
  }
  limit_memory(options.memory);
  if (const std::string name = chosen_verb(app); name != "track" && name != "sweep") limit_time(options.time);
  if (const auto kernels = instruction_set_named(options.kernels); kernels && !pin_instruction_set(*kernels))
    return fail({fmt::format("--kernels {}: this processor supports {} at most", options.kernels,
                             name(widest_instruction_set()))});
  if (options.language == "names") words::set_language(words::Language::names);
  for (const Verb& verb : verbs)
    if (was_chosen(*verb.command)) return verb.run();
  return exit_bad_input;
}

}  // namespace kinfer::cli

int main(int argc, char** argv) {
  // glibc raises this threshold dynamically up to 32 MB, and blocks below it are not returned to the system: an hour of
  // six sensors then took a third more memory.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  // Derivatives of thousands of poses are many small blocks, allocated and released in each step of a fit: giving them
  // back to the system each time cost a tenth of the processor time.
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
  try {
    kinfer::cli::prepare_process();
    if (!kinfer::cli::enlarge_stack()) return kinfer::cli::exit_bad_input;
    const int code = kinfer::cli::Program().run({argv + std::min(argc, 1), argv + argc});
    return kinfer::cli::flush_standard_output() ? code : kinfer::cli::exit_bad_input;
  } catch (const std::exception&) {
    return kinfer::cli::code_of_exception();
  }
}
