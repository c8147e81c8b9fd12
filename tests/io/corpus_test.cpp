// SPDX-License-Identifier: Apache-2.0
// The corpus of the fuzzers, read by every reader: what went wrong once does not again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/readers.hpp"

namespace kinfer::fuzz {
namespace {

TEST(Corpus, EveryReaderReturnsFromEveryFile) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(KINFER_SOURCE_DIR "/fuzz/corpus")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    for (const Reader& reader : readers()) reader.read(bytes);
  }
  EXPECT_GE(files, 25);
}

TEST(Corpus, EveryReaderHasFiles) {
  for (const Reader& reader : readers())
    EXPECT_TRUE(std::filesystem::is_directory(KINFER_SOURCE_DIR "/fuzz/corpus/" + std::string(reader.name)))
        << reader.name;
}

}  // namespace
}  // namespace kinfer::fuzz
