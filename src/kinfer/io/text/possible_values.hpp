// SPDX-License-Identifier: Apache-2.0
// Numbers of a TOML table that are in the range of their quantity; one that is not is reported with its line.
#pragma once

#include <fmt/format.h>

#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {

inline double within(TableReader& reader, std::string_view key, const PossibleRange& range) {
  const double value = reader.number(key);
  reader.expect_possible(key, value, range);
  return value;
}

/// A standard deviation, or another size: not negative.
inline double magnitude(TableReader& reader, std::string_view key, const PossibleRange& range) {
  const double value = within(reader, key, range);
  if (value < 0.0)
    reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected a number that is not negative", key));
  return value;
}

inline Vec3 vector_within(TableReader& reader, std::string_view key, const PossibleRange& range) {
  Vec3 values = reader.vector(key);
  for (const double value : values) reader.expect_possible(key, value, range);
  return values;
}

/// Of no particular quantity, but finite.
inline std::vector<double> possible_numbers(TableReader& reader, std::string_view key, std::size_t count) {
  std::vector<double> numbers = reader.numbers(key, count);
  for (const double value : numbers) reader.expect_possible(key, value, possible::number);
  return numbers;
}

}  // namespace kinfer
