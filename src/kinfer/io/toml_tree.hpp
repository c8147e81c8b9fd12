// TOML as plain values that know their line, and a reader that complains in sentences.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/complaint.hpp"

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
      value;     ///< integers are doubles; dates nothing
  int line = 0;  ///< from 1
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

Result<TomlTable> parse_toml(std::string_view text, const std::string& name_in_messages);

/// Reads one table. A key that is missing or of the wrong type goes to the complaint and reads as zero, so that the
/// caller needs to look at the complaint only once; `expect_no_other_keys` complains about keys that nobody asked for.
class TableReader {
 public:
  /// `where` opens each sentence: "joint 3: ", or nothing for the file's own table.
  TableReader(const TomlTable& table, int line, std::string where, Complaint& complaint);

  bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  int line() const { return line_; }
  int line_of(std::string_view key) const;
  void complain(int line, const std::string& sentence) const { complaint_.say(line, where_ + sentence); }

  double number(std::string_view key);  ///< finite
  double number_or(std::string_view key, double absent);
  double positive_or(std::string_view key, double absent);
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, const std::string& absent);
  bool flag_or(std::string_view key, bool absent);
  Vec3 vector(std::string_view key);
  Vec3 vector_or(std::string_view key, const Vec3& absent);
  std::vector<double> numbers(std::string_view key, std::size_t count);  ///< infinities are allowed
  std::vector<double> number_list(std::string_view key);                 ///< finite, any number of them
  std::vector<Vec3> vectors_or_none(std::string_view key);
  const TomlTable* table_or_none(std::string_view key);
  std::vector<std::pair<const TomlTable*, int>> tables_or_none(std::string_view key);  ///< [[key]], each with its line
  void ignore(std::string_view key) { asked_.emplace_back(key); }

  void expect_no_other_keys() const;

 private:
  const TomlValue* ask(std::string_view key);
  const TomlValue* require(std::string_view key, std::string_view expected);
  double finite(const TomlValue& value, std::string_view key) const;
  Vec3 three(const TomlValue& value, std::string_view key) const;
  void wrong_type(const TomlValue& value, std::string_view key, std::string_view expected) const;

  const TomlTable& table_;
  int line_;
  std::string where_;
  Complaint& complaint_;
  std::vector<std::string> asked_;
};

}  // namespace kinfer
