// SPDX-License-Identifier: Apache-2.0
// What is tried in an instrumented build, which takes five times as long.
#pragma once

#include <initializer_list>
#include <vector>

namespace kinfer::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_instrumented = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool is_instrumented = true;
#else
inline constexpr bool is_instrumented = false;
#endif
#else
inline constexpr bool is_instrumented = false;
#endif

/// Seeds or machines that run the same code: all of them where figures are judged, the first where memory is.
template <class T>
std::vector<T> repeats(std::initializer_list<T> values) {
  std::vector<T> tried(values);
  if (is_instrumented) tried.resize(1);
  return tried;
}

}  // namespace kinfer::test
