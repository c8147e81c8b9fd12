// For mistakes of the programmer (wrong shape, index out of range): stops with file, line and values. On in every
// build.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace kinfer {

/// Prints the broken expectation to stderr and aborts.
[[noreturn]] void expectation_failed(const char* file, int line, std::string_view condition, const std::string& detail);

}  // namespace kinfer

/// KINFER_EXPECT(q.size() == n) or KINFER_EXPECT(q.size() == n, "{} readings for {} joints", q.size(), n)
#define KINFER_EXPECT(condition, ...)                                                                              \
  do {                                                                                                             \
    if (!(condition)) ::kinfer::expectation_failed(__FILE__, __LINE__, #condition, ::fmt::format("" __VA_ARGS__)); \
  } while (false)
