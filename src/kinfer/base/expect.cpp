// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/expect.hpp"

#include <cstdio>
#include <cstdlib>

namespace kinfer {

void expectation_failed(const char* file, int line, std::string_view condition, const std::string& detail) {
  fmt::print(stderr, "{}:{}: expected {}{}{}\n", file, line, condition, detail.empty() ? "" : ": ", detail);
  std::fflush(stderr);
  std::abort();
}

}  // namespace kinfer
