// SPDX-License-Identifier: Apache-2.0
// Writes members as JSON. A number that is not finite is null in the file.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "kinfer/evidence/facts/fact.hpp"
#include "kinfer/io/evidence/json/json_text.hpp"
#include "kinfer/io/evidence/json/json_types.hpp"

namespace kinfer::evidence_json {

// What JSON holds itself. Compiled once: a hundred members of structs write doubles.
Json json_value(bool value);
Json json_value(std::int64_t value);
Json json_value(std::uint64_t value);
Json json_value(double value);
Json json_value(const std::string& value);
Json json_value(std::span<const double> values);

class JsonWriter {
 public:
  static constexpr bool is_writer = true;

  void constant(const char* key, const char* text) { set(key, json_value(std::string(text))); }

  template <class T>
  void operator()(const char* key, const T& value) {
    set(key, json_of(value));
  }

  /// A key that older files lack.
  template <class T>
  void later(const char* key, const T& value) {
    (*this)(key, value);
  }

  /// A key that is left out unless `present`.
  template <class T>
  void when(bool present, const char* key, const T& value) {
    if (present) (*this)(key, value);
  }

  /// null unless `known`
  template <class T>
  void known(bool known, const char* key, const T& value) {
    set(key, known ? json_of(value) : Json(nullptr));
  }

  /// An object of its own; `members` is called with its archive.
  template <class Members>
  void group(const char* key, Members&& members) {
    JsonWriter inner;
    members(inner);
    set(key, std::move(inner.json_));
  }

  /// One member of every element of a list.
  template <class Element, class T>
  void column(const char* key, const std::vector<Element>& list, T Element::*member) {
    Json values = Json::array();
    for (const Element& element : list) append(values, json_of(element.*member));
    set(key, std::move(values));
  }

  /// The same for numbers of a drawing, whose zeros are short.
  template <class Element>
  void plotted_column(const char* key, const std::vector<Element>& list, double Element::*member) {
    std::vector<double> values;
    for (const Element& element : list) values.push_back(element.*member);
    plotted_list(key, values);
  }
  void plotted_list(const char* key, const std::vector<double>& list);

  /// Pairs of a name and a value, as an object.
  template <class T>
  void map(const char* key, const std::vector<std::pair<std::string, T>>& entries) {
    JsonWriter object;
    for (const auto& [name, value] : entries) object.set(name, json_of(value));
    set(key, std::move(object.json_));
  }

  void matrix_rows(const char* key, const MatrixXd& matrix) { matrix_columns(key, matrix.transpose()); }
  void matrix_columns(const char* key, const MatrixXd& matrix);

  template <class T>
  static Json json_of(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return json_value(text_of(value));
    } else if constexpr (std::is_same_v<T, bool> || std::is_floating_point_v<T> || std::is_same_v<T, std::string>) {
      return json_value(value);
    } else if constexpr (std::is_unsigned_v<T>) {
      return json_value(static_cast<std::uint64_t>(value));
    } else if constexpr (std::is_integral_v<T>) {
      return json_value(static_cast<std::int64_t>(value));
    } else if constexpr (IsOptional<T>::value) {
      return value ? json_of(*value) : Json(nullptr);
    } else if constexpr (std::is_same_v<T, FactValues>) {
      JsonWriter object;
      for (const auto& [name, fact] : value)
        object.set(name, std::visit([](const auto& v) { return json_of(v); }, fact));
      return std::move(object.json_);
    } else if constexpr (IsPair<T>::value) {
      return Json::array({json_of(value.first), json_of(value.second)});
    } else if constexpr (std::is_same_v<element_of<T>, double>) {
      return json_value(std::span<const double>(value.data(), static_cast<std::size_t>(value.size())));
    } else if constexpr (IsVector<T>::value || IsArray<T>::value) {
      Json list = Json::array();
      for (const auto& element : value) append(list, json_of(static_cast<element_of<T>>(element)));
      return list;
    } else {
      return object_of(value);
    }
  }

  /// The members of a struct.
  template <class T>
  static Json object_of(const T& value) {
    JsonWriter writer;
    fields(writer, value);
    return std::move(writer.json_);
  }

  const Json& json() const { return json_; }

 private:
  template <class T>
  struct Element {
    using type = void;
  };
  template <class T>
  requires requires { typename T::value_type; }
  struct Element<T> {
    using type = typename T::value_type;
  };
  template <class T>
  using element_of = typename Element<T>::type;

  void set(const std::string& key, Json value);
  static void append(Json& list, Json value);

  Json json_ = Json::object();
};

}  // namespace kinfer::evidence_json
