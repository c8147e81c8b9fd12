// SPDX-License-Identifier: Apache-2.0
// Writes members as JSON. A number that is not finite is null in the file.
#pragma once

#include <string>
#include <utility>

#include "kinfer/evidence/facts/fact.hpp"
#include "kinfer/io/evidence/json/json_text.hpp"
#include "kinfer/io/evidence/json/json_types.hpp"

namespace kinfer::evidence_json {

class JsonWriter {
 public:
  static constexpr bool is_writer = true;

  void constant(const char* key, const char* text) { json_[key] = text; }

  template <class T>
  void operator()(const char* key, const T& value) {
    json_[key] = json_of(value);
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
    json_[key] = known ? json_of(value) : Json(nullptr);
  }

  /// An object of its own; `members` is called with its archive.
  template <class Members>
  void group(const char* key, Members&& members) {
    JsonWriter inner;
    members(inner);
    json_[key] = std::move(inner.json_);
  }

  /// One member of every element of a list.
  template <class Element, class T>
  void column(const char* key, const std::vector<Element>& list, T Element::*member) {
    Json& values = json_[key] = Json::array();
    for (const Element& element : list) values.push_back(json_of(element.*member));
  }

  /// The same for numbers of a drawing, whose zeros are short.
  template <class Element>
  void plotted_column(const char* key, const std::vector<Element>& list, double Element::*member) {
    Json& values = json_[key] = Json::array();
    for (const Element& element : list) values.push_back(plotted(element.*member));
  }
  void plotted_list(const char* key, const std::vector<double>& list) {
    Json& values = json_[key] = Json::array();
    for (const double value : list) values.push_back(plotted(value));
  }

  /// Pairs of a name and a value, as an object.
  template <class T>
  void map(const char* key, const std::vector<std::pair<std::string, T>>& entries) {
    Json& object = json_[key] = Json::object();
    for (const auto& [name, value] : entries) object[name] = json_of(value);
  }

  void matrix_rows(const char* key, const MatrixXd& matrix) { matrix_columns(key, matrix.transpose()); }
  void matrix_columns(const char* key, const MatrixXd& matrix) {
    Json& columns = json_[key] = Json::array();
    for (Eigen::Index k = 0; k < matrix.cols(); ++k)
      columns.push_back(std::vector<double>(matrix.col(k).begin(), matrix.col(k).end()));
  }

  template <class T>
  static Json json_of(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return text_of(value);
    } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      return value;
    } else if constexpr (IsOptional<T>::value) {
      return value ? json_of(*value) : Json(nullptr);
    } else if constexpr (std::is_same_v<T, FactValues>) {
      Json object = Json::object();
      for (const auto& [name, fact] : value) object[name] = std::visit([](const auto& v) { return json_of(v); }, fact);
      return object;
    } else if constexpr (IsPair<T>::value) {
      return Json::array({json_of(value.first), json_of(value.second)});
    } else if constexpr (IsVector<T>::value || IsArray<T>::value || std::is_same_v<T, VectorXd>) {
      Json list = Json::array();
      for (const auto& element : value) list.push_back(json_of(static_cast<element_of<T>>(element)));
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
  using element_of = typename T::value_type;

  static Json plotted(double value) { return value == 0.0 ? Json(0) : Json(value); }

  Json json_ = Json::object();
};

}  // namespace kinfer::evidence_json
