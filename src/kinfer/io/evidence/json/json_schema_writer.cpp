// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/json/json_schema_writer.hpp"

namespace kinfer::evidence_json {

Json number_schema() {
  return {{"type", {"number", "null"}}};
}

Json list_schema(Json element) {
  return {{"type", "array"}, {"items", std::move(element)}};
}

Json list_schema(Json element, std::size_t size) {
  Json list = list_schema(std::move(element));
  list["minItems"] = list["maxItems"] = size;
  return list;
}

Json map_schema(Json value) {
  return {{"type", "object"}, {"additionalProperties", std::move(value)}};
}

Json nullable(Json schema) {
  return {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}};
}

Json JsonSchemaWriter::schema() const {
  return {{"type", "object"}, {"properties", properties_}, {"required", required_}};
}

void JsonSchemaWriter::add(const char* key, Json schema) {
  properties_[key] = std::move(schema);
}

void JsonSchemaWriter::require(const char* key, Json schema) {
  add(key, std::move(schema));
  required_.push_back(key);
}

}  // namespace kinfer::evidence_json
