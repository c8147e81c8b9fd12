// SPDX-License-Identifier: Apache-2.0
// Inputs, options and seed of a result, enough to reproduce it; nothing that differs from run to run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinfer {

struct InputFile {
  std::string name;  ///< without directories
  std::string sha256;
  std::string
      samples{};  ///< of a recording, what it holds (measurement/ins/sample_digest); of several logs, at the first
};

struct Provenance {
  std::vector<InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> options;  ///< as given, --name and value
  std::uint64_t seed = 1;
  std::vector<InputFile> earlier_inputs{};  ///< of all identifications that this one updates, oldest first
};

}  // namespace kinfer
