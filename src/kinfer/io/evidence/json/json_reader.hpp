// SPDX-License-Identifier: Apache-2.0
// Reads members from JSON. The first value that is missing or of another type is the error of the whole file, named by
// its path: "joints[2].sd.slide_m: expected a number". Keys that no member has are ignored; null reads as NaN where a
// number is expected.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "kinfer/evidence/facts/fact.hpp"
#include "kinfer/io/evidence/json/json_text.hpp"
#include "kinfer/io/evidence/json/json_types.hpp"

namespace kinfer::evidence_json {

/// The way from the root of the file to a value.
struct JsonPath {
  const JsonPath* parent = nullptr;
  const char* key = nullptr;
  std::size_t index = 0;  ///< in a list; where there is no key

  std::string text() const;
};

/// The first error of a file.
class ReadErrors {
 public:
  void add(const JsonPath& path, std::string_view what);
  const std::optional<std::string>& first() const { return first_; }

 private:
  std::optional<std::string> first_;
};

FactValue read_fact(const Json& json);  ///< a number, a text, or a list of one kind of these

class JsonReader {
 public:
  static constexpr bool is_writer = false;

  JsonReader(const Json& object, const JsonPath& path, ReadErrors& errors)
      : object_(object), path_(path), errors_(errors) {}

  void constant(const char* key, const char* text);

  template <class T>
  void operator()(const char* key, T& value) {
    if (const Json* json = required(key)) read(*json, at(key), value);
  }

  template <class T>
  void later(const char* key, T& value) {
    if (const Json* json = find(key)) read(*json, at(key), value);
  }

  template <class T>
  void when(bool, const char* key, T& value) {
    later(key, value);
  }

  template <class T>
  void known(bool, const char* key, T& value) {
    const Json* json = required(key);
    if (json && !json->is_null()) read(*json, at(key), value);
  }

  template <class Members>
  void group(const char* key, Members&& members) {
    const Json* json = required(key);
    if (!json) return;
    const JsonPath path = at(key);
    if (!json->is_object()) return errors_.add(path, "expected an object");
    JsonReader inner(*json, path, errors_);
    members(inner);
  }

  template <class Element, class T>
  void column(const char* key, std::vector<Element>& list, T Element::*member) {
    std::vector<T> values;
    (*this)(key, values);
    if (list.empty()) list.resize(values.size());
    if (list.size() != values.size())
      return errors_.add(at(key), "expected " + std::to_string(list.size()) + " values");
    for (std::size_t i = 0; i < list.size(); ++i) list[i].*member = values[i];
  }
  template <class Element>
  void plotted_column(const char* key, std::vector<Element>& list, double Element::*member) {
    column(key, list, member);
  }
  void plotted_list(const char* key, std::vector<double>& list) { (*this)(key, list); }

  template <class T>
  void map(const char* key, std::vector<std::pair<std::string, T>>& entries) {
    const Json* json = required(key);
    if (!json) return;
    const JsonPath path = at(key);
    if (!json->is_object()) return errors_.add(path, "expected an object");
    entries.clear();
    for (const auto& [name, value] : json->items()) {
      entries.emplace_back(name, T{});
      read(value, {&path, name.c_str()}, entries.back().second);
    }
  }

  void matrix_rows(const char* key, MatrixXd& matrix);
  void matrix_columns(const char* key, MatrixXd& matrix);

  /// For checks that concern several members.
  void error(const char* key, std::string_view what) { errors_.add(at(key), what); }

  template <class T>
  void read(const Json& json, const JsonPath& path, T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, double> || std::is_same_v<T, std::string>) {
      read_value(json, path, value);
    } else if constexpr (std::is_unsigned_v<T>) {
      if (const auto whole = read_unsigned(json, path, std::numeric_limits<T>::max())) value = static_cast<T>(*whole);
    } else if constexpr (std::is_integral_v<T>) {
      constexpr auto limits = std::numeric_limits<T>();
      if (const auto whole = read_integer(json, path, limits.min(), limits.max())) value = static_cast<T>(*whole);
    } else if constexpr (std::is_enum_v<T>) {
      if (!json.is_string() || !from_text(json.template get_ref<const std::string&>(), value))
        errors_.add(path, "unknown name");
    } else if constexpr (IsOptional<T>::value) {
      value.reset();
      if (!json.is_null()) read(json, path, value.emplace());
    } else if constexpr (std::is_same_v<T, FactValues>) {
      read_facts(json, path, value);
    } else if constexpr (IsPair<T>::value) {
      if (!is_list(json, path, 2)) return;
      read(json[0], {&path, nullptr, 0}, value.first);
      read(json[1], {&path, nullptr, 1}, value.second);
    } else if constexpr (IsArray<T>::value) {
      if (!is_list(json, path, static_cast<std::size_t>(value.size()))) return;
      for (std::size_t i = 0; i < json.size(); ++i) read(json[i], {&path, nullptr, i}, value[i]);
    } else if constexpr (std::is_same_v<T, VectorXd>) {
      std::vector<double> list;
      read(json, path, list);
      value = Eigen::Map<const VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
    } else if constexpr (IsVector<T>::value) {
      if (!json.is_array()) return errors_.add(path, "expected a list");
      value.clear();
      for (std::size_t i = 0; i < json.size(); ++i) {
        typename T::value_type element{};
        read(json[i], {&path, nullptr, i}, element);
        value.push_back(std::move(element));
      }
    } else {
      if (!json.is_object()) return errors_.add(path, "expected an object");
      JsonReader inner(json, path, errors_);
      fields(inner, value);
    }
  }

 private:
  // What JSON holds itself. Compiled once: a hundred members of structs are doubles.
  void read_value(const Json& json, const JsonPath& path, bool& value);
  void read_value(const Json& json, const JsonPath& path, double& value);
  void read_value(const Json& json, const JsonPath& path, std::string& value);
  std::optional<std::uint64_t> read_unsigned(const Json& json, const JsonPath& path, std::uint64_t max);
  std::optional<std::int64_t> read_integer(const Json& json, const JsonPath& path, std::int64_t min, std::int64_t max);

  JsonPath at(const char* key) const { return {&path_, key}; }
  const Json* find(const char* key) const;
  const Json* required(const char* key);  ///< null, and an error, if it is missing
  bool is_list(const Json& json, const JsonPath& path, std::size_t size);
  void read_facts(const Json& json, const JsonPath& path, FactValues& facts);

  const Json& object_;
  const JsonPath& path_;
  ReadErrors& errors_;
};

}  // namespace kinfer::evidence_json
