// SPDX-License-Identifier: Apache-2.0
// Return type of functions that can fail on bad input: the value, or one sentence that the user can act on.
#pragma once

#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace kinfer {

struct Error {
  std::string what;  ///< names file, line, column and what was expected: `poses.csv:14: expected 9 columns, found 8`
};

template <class T>
using Result = tl::expected<T, Error>;

/// The sentence without words of unbounded length, which a damaged file may have: a long sentence keeps the first
/// characters of each word of more than 200 bytes and says how many it had, and ends after 2000 bytes.
std::string bounded_sentence(std::string text);

/// `return error("{}: no such file", path);` from any function that returns a Result.
template <class... Args>
tl::unexpected<Error> error(fmt::format_string<Args...> text, Args&&... args) {
  return tl::unexpected<Error>(Error{bounded_sentence(fmt::format(text, std::forward<Args>(args)...))});
}

/// Converts an error to the Result type of the caller.
inline tl::unexpected<Error> forward_error(Error failure) {
  return tl::unexpected<Error>(std::move(failure));
}

}  // namespace kinfer

/// Evaluates `expression`; returns its error from the calling function, or makes `name` its value.
#define KINFER_TRY(name, expression)                                                    \
  auto name##_result = (expression);                                                    \
  if (!name##_result) return ::kinfer::forward_error(std::move(name##_result).error()); \
  auto name = std::move(*name##_result)
