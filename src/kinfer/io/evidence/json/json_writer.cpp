// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/json/json_writer.hpp"

namespace kinfer::evidence_json {

Json json_value(bool value) {
  return value;
}
Json json_value(std::int64_t value) {
  return value;
}
Json json_value(std::uint64_t value) {
  return value;
}
Json json_value(double value) {
  return value;
}
Json json_value(const std::string& value) {
  return value;
}
Json json_value(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(value);
  return list;
}

void JsonWriter::set(const std::string& key, Json value) {
  json_[key] = std::move(value);
}

void JsonWriter::append(Json& list, Json value) {
  list.push_back(std::move(value));
}

void JsonWriter::plotted_list(const char* key, const std::vector<double>& list) {
  Json values = Json::array();
  for (const double value : list) values.push_back(value == 0.0 ? Json(0) : Json(value));
  set(key, std::move(values));
}

void JsonWriter::matrix_columns(const char* key, const MatrixXd& matrix) {
  Json columns = Json::array();
  for (Eigen::Index k = 0; k < matrix.cols(); ++k)
    columns.push_back(json_value(std::span(matrix.col(k).data(), static_cast<std::size_t>(matrix.rows()))));
  set(key, std::move(columns));
}

}  // namespace kinfer::evidence_json
