// SPDX-License-Identifier: Apache-2.0
// TOML as plain values with line numbers, and a table reader that reports errors as sentences.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/text/first_error.hpp"
#include "kinfer/io/text/possible_range.hpp"

namespace kinfer {

struct TomlValue;
struct TomlEntry;
using TomlArray = std::vector<TomlValue>;

/// Keys in the order of the file.
struct TomlTable {
  std::vector<TomlEntry> entries;
  const TomlValue* find(std::string_view key) const;  ///< null where there is none
};

struct TomlValue {
  std::variant<std::monostate, bool, double, std::string, TomlArray, TomlTable>
      value;     ///< integers become doubles, dates monostate
  int line = 0;  ///< from 1
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

Result<TomlTable> parse_toml(std::string_view text, const std::string& name_in_messages);

/// Reads one table. A key that is missing or of the wrong type is reported to the complaint and reads as zero, so that
/// the caller checks for errors only once; `expect_no_other_keys` reports the keys that were never read or ignored.
class TableReader {
 public:
  /// `where` is the prefix of each sentence: "joint 3: ", or empty for the file's top-level table.
  TableReader(const TomlTable& table, int line, std::string prefix, FirstError& first_error);

  bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  int line() const { return line_; }
  int line_of(std::string_view key) const;
  void report_error(int line, const std::string& sentence) const { first_error_.report(line, prefix_ + sentence); }

  double number(std::string_view key);  ///< finite
  double number_or(std::string_view key, double fallback);
  double positive_or(std::string_view key, double fallback);
  /// Reports a value of the key, in SI, that its quantity cannot have; an infinite one too.
  void expect_possible(std::string_view key, double value, const PossibleRange& range) const;
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, const std::string& fallback);
  bool flag_or(std::string_view key, bool fallback);
  Vec3 vector(std::string_view key);
  Vec3 vector_or(std::string_view key, const Vec3& fallback);
  std::vector<double> numbers(std::string_view key, std::size_t count);  ///< infinities are allowed
  std::vector<double> number_list(std::string_view key);                 ///< finite, any number of them
  std::vector<Vec3> vectors_or_none(std::string_view key);
  const TomlTable* table_or_none(std::string_view key);
  std::vector<std::pair<const TomlTable*, int>> tables_or_none(std::string_view key);  ///< [[key]], each with its line
  void ignore(std::string_view key) { read_keys_.emplace_back(key); }

  void expect_no_other_keys() const;

 private:
  const TomlValue* lookup(std::string_view key);
  const TomlValue* require(std::string_view key, std::string_view expected);
  double finite(const TomlValue& value, std::string_view key) const;
  Vec3 read_vector(const TomlValue& value, std::string_view key) const;
  void wrong_type(const TomlValue& value, std::string_view key, std::string_view expected) const;

  const TomlTable& table_;
  int line_;
  std::string prefix_;
  FirstError& first_error_;
  std::vector<std::string> read_keys_;
};

}  // namespace kinfer
