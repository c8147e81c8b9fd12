// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/fingerprints.hpp"

#include <filesystem>

#include "kinfer/base/sha256.hpp"

namespace kinfer {

std::vector<InputFile> fingerprints(const std::vector<std::string>& paths) {
  std::vector<InputFile> files;
  for (const std::string& path : paths)
    if (const auto fingerprint = sha256_of_file(path))
      files.push_back({std::filesystem::path(path).filename().string(), *fingerprint});
  return files;
}

}  // namespace kinfer
