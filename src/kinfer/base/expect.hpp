// SPDX-License-Identifier: Apache-2.0
// Assertions for programming errors (wrong shape, index out of range): abort with file, line and values. Enabled in
// every build.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace kinfer {

/// Prints the broken expectation to stderr and aborts.
[[noreturn]] void expectation_failed(const char* file, int line, std::string_view condition, const std::string& detail);

}  // namespace kinfer

/// KINFER_EXPECT(q.size() == n) or KINFER_EXPECT(q.size() == n, "{} positions for {} joints", q.size(), n)
#define KINFER_EXPECT(condition, ...)                                                                              \
  do {                                                                                                             \
    if (!(condition)) ::kinfer::expectation_failed(__FILE__, __LINE__, #condition, ::fmt::format("" __VA_ARGS__)); \
  } while (false)
