// SPDX-License-Identifier: Apache-2.0
// The arguments of a study, with --help and an error for what it does not know.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace kinfer::study {

/// The present values of the options that are added become their defaults.
class ArgumentParser : public CLI::App {
 public:
  explicit ArgumentParser(const std::string& what) : CLI::App(what) { option_defaults()->always_capture_default(); }

  /// The exit code where the study is not to run: after --help, or where an argument is wrong.
  std::optional<int> exit_code(int argc, char** argv) {
    try {
      parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return exit(error);
    }
    return std::nullopt;
  }
};

}  // namespace kinfer::study
