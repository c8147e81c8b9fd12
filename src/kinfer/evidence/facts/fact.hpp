// SPDX-License-Identifier: Apache-2.0
// The values of a fact: what its sentence needs, by name and in SI units. A fact carries no words; `words` makes them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kinfer {

using FactValue =
    std::variant<double, int, std::string, std::vector<double>, std::vector<int>, std::vector<std::string>>;

/// Named values in the order in which they were given; the names are the keys in evidence.json.
class FactValues {
 public:
  using Entry = std::pair<std::string, FactValue>;

  FactValues() = default;
  FactValues(std::initializer_list<Entry> entries) : entries_(entries) {}
  explicit FactValues(std::vector<Entry> entries) : entries_(std::move(entries)) {}

  bool has(std::string_view name) const { return find(name) != nullptr; }
  void set(std::string name, FactValue value);

  /// The value of that name; the maker of the fact must have given it, with this type.
  double number(std::string_view name) const;
  int count(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  const std::vector<double>& numbers(std::string_view name) const;
  const std::vector<int>& counts(std::string_view name) const;
  const std::vector<std::string>& texts(std::string_view name) const;

  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  bool empty() const { return entries_.empty(); }
  friend bool operator==(const FactValues&, const FactValues&) = default;

 private:
  const FactValue* find(std::string_view name) const;

  std::vector<Entry> entries_;
};

}  // namespace kinfer
