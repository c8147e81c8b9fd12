// SPDX-License-Identifier: Apache-2.0
// The third archive of `fields`: it writes no values but their types, as a JSON Schema (draft 2020-12). Members that
// older files lack, and those that depend on the result, are not required.
#pragma once

#include <string>
#include <utility>

#include "kinfer/evidence/facts/fact.hpp"
#include "kinfer/io/evidence/json/json_text.hpp"
#include "kinfer/io/evidence/json/json_types.hpp"

namespace kinfer::evidence_json {

Json number_schema();  ///< null stands for a number that is not finite
Json list_schema(Json element);
Json list_schema(Json element, std::size_t size);
Json map_schema(Json value);  ///< an object with any keys
Json nullable(Json schema);

class JsonSchemaWriter {
 public:
  static constexpr bool is_writer = true;

  void constant(const char* key, const char* text) { require(key, {{"const", text}}); }

  template <class T>
  void operator()(const char* key, const T&) {
    require(key, schema_of<T>());
  }
  template <class T>
  void later(const char* key, const T&) {
    add(key, schema_of<T>());
  }
  template <class T>
  void when(bool, const char* key, const T&) {
    add(key, schema_of<T>());
  }
  template <class T>
  void known(bool, const char* key, const T&) {
    require(key, nullable(schema_of<T>()));
  }

  template <class Members>
  void group(const char* key, Members&& members) {
    JsonSchemaWriter inner;
    members(inner);
    require(key, inner.schema());
  }

  template <class Element, class T>
  void column(const char* key, const std::vector<Element>&, T Element::*) {
    require(key, list_schema(schema_of<T>()));
  }
  template <class Element>
  void plotted_column(const char* key, const std::vector<Element>&, double Element::*) {
    require(key, list_schema(number_schema()));
  }
  void plotted_list(const char* key, const std::vector<double>&) { require(key, list_schema(number_schema())); }

  template <class T>
  void map(const char* key, const std::vector<std::pair<std::string, T>>&) {
    require(key, map_schema(schema_of<T>()));
  }
  void matrix_rows(const char* key, const MatrixXd&) { require(key, list_schema(list_schema(number_schema()))); }
  void matrix_columns(const char* key, const MatrixXd& matrix) { matrix_rows(key, matrix); }

  template <class T>
  static Json schema_of() {
    if constexpr (std::is_enum_v<T>) {
      return {{"enum", names_of<T>()}};
    } else if constexpr (std::is_same_v<T, bool>) {
      return {{"type", "boolean"}};
    } else if constexpr (std::is_integral_v<T>) {
      return {{"type", "integer"}};
    } else if constexpr (std::is_floating_point_v<T>) {
      return number_schema();
    } else if constexpr (std::is_same_v<T, std::string>) {
      return {{"type", "string"}};
    } else if constexpr (IsOptional<T>::value) {
      return nullable(schema_of<typename T::value_type>());
    } else if constexpr (std::is_same_v<T, FactValues>) {
      return {{"type", "object"}};
    } else if constexpr (IsPair<T>::value) {
      return list_schema(Json::object(), 2);
    } else if constexpr (IsArray<T>::value) {
      return list_schema(schema_of<std::remove_cvref_t<decltype(T{}[0])>>(), static_cast<std::size_t>(T{}.size()));
    } else if constexpr (std::is_same_v<T, VectorXd>) {
      return list_schema(number_schema());
    } else if constexpr (IsVector<T>::value) {
      return list_schema(schema_of<typename T::value_type>());
    } else {
      return object_schema<T>();
    }
  }

  /// Of a struct.
  template <class T>
  static Json object_schema() {
    JsonSchemaWriter writer;
    const T value{};
    fields(writer, value);
    return writer.schema();
  }

  Json schema() const;

 private:
  void add(const char* key, Json schema);
  void require(const char* key, Json schema);

  Json properties_ = Json::object();
  Json required_ = Json::array();
};

}  // namespace kinfer::evidence_json
