// SPDX-License-Identifier: Apache-2.0
// The program: one file per verb; exit codes as documented in docs/formats.md.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>
#include <vector>

#include "kinfer/base/version.hpp"
#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/task_pool.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/words/language.hpp"

namespace {

int run(const std::vector<std::string>& words) {
  using namespace kinfer::cli;
  store_command_line(words);
  CLI::App app("kinfer: from raw measurements to a proven kinematic model", "kinfer");
  app.set_version_flag("--version", std::string("kinfer ") + kinfer::version);
  std::string language = "english";
  app.add_option("--language", language,
                 "names: the stable name of each fact instead of its sentence, for programs and translators")
      ->check(CLI::IsMember({"english", "names"}))
      ->capture_default_str();
  app.require_subcommand(1);
  app.footer("\n`kinfer VERB --help` explains a verb and shows an example.");
  const std::vector<Verb> verbs = add_verbs(app);
  try {
    // CLI11 takes the words without the program's name, the last one first.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend() - 1));
  } catch (const CLI::ParseError& parse_error) {
    return app.exit(parse_error) == 0 ? exit_done : exit_bad_input;  // --help and --version end here too
  }
  if (language == "names") kinfer::words::set_language(kinfer::words::Language::names);
  for (const Verb& verb : verbs)
    if (was_chosen(*verb.command)) return verb.run();
  return exit_bad_input;
}

int run_guarded(const std::vector<std::string>& words) {
  try {
    return run(words);
  } catch (const std::exception& failure) {
    fmt::print(stderr, "kinfer: internal error: {}\n", failure.what());
    return kinfer::cli::exit_internal;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // glibc raises this threshold dynamically up to 32 MB, and blocks below it are not returned to the system: an hour of
  // six sensors then took a third more memory.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  kinfer::cli::set_program_call([](std::vector<std::string> words) {
    words.insert(words.begin(), "kinfer");
    return run_guarded(words);
  });
  return run_guarded(std::vector<std::string>(argv, argv + argc));
}
