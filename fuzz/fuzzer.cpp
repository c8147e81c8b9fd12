// SPDX-License-Identifier: Apache-2.0
// libFuzzer's entry for the reader that the environment names: KINFER_READER=urdf fuzz_readers fuzz/corpus/urdf
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fuzz/readers.hpp"

namespace {
const kinfer::fuzz::Reader* chosen = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("KINFER_READER");
  chosen = kinfer::fuzz::find_reader(name ? name : "");
  if (chosen) return 0;
  std::fputs("KINFER_READER: expected one of", stderr);
  for (const auto& reader : kinfer::fuzz::readers()) std::fprintf(stderr, " %s", std::string(reader.name).c_str());
  std::fputs("\n", stderr);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->read({reinterpret_cast<const char*>(data), size});
  return 0;
}
