// SPDX-License-Identifier: Apache-2.0
// What is tried in an instrumented build, which takes five times as long.
#pragma once

#include <initializer_list>
#include <vector>

#if defined(__has_feature)
#define KINFER_HAS_SANITIZER (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KINFER_HAS_SANITIZER 1
#else
#define KINFER_HAS_SANITIZER 0
#endif

namespace kinfer::test {

inline constexpr bool is_instrumented = KINFER_HAS_SANITIZER;

/// Seeds or machines that run the same code: all of them where figures are judged, the first where memory is.
template <class T>
std::vector<T> repeats(std::initializer_list<T> values) {
  std::vector<T> tried(values);
  if (is_instrumented) tried.resize(1);
  return tried;
}

}  // namespace kinfer::test
