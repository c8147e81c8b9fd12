// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/json/json_reader.hpp"

#include <algorithm>

namespace kinfer::evidence_json {
namespace {

constexpr double largest_number = 1e100;  // no result comes near; squares and sums of it stay finite

FactValue fact_list(const Json& json) {
  const auto all = [&](auto is_kind) { return !json.empty() && std::ranges::all_of(json, is_kind); };
  if (all([](const Json& j) { return j.is_string(); })) return json.get<std::vector<std::string>>();
  if (all([](const Json& j) { return j.is_number_integer(); })) return json.get<std::vector<int>>();
  std::vector<double> numbers;
  for (const Json& value : json) numbers.push_back(value.is_number() ? value.get<double>() : NAN);
  return numbers;
}

bool is_fact(const Json& json) {
  const auto is_single = [](const Json& j) { return j.is_number() || j.is_string() || j.is_null(); };
  return is_single(json) || (json.is_array() && std::ranges::all_of(json, is_single));
}

}  // namespace

std::string JsonPath::text() const {
  if (!parent) return {};
  const std::string before = parent->text();
  if (!key) return before + "[" + std::to_string(index) + "]";
  return before.empty() ? key : before + "." + key;
}

void ReadErrors::add(const JsonPath& path, std::string_view what) {
  if (!first_) first_ = path.text() + ": " + std::string(what);
}

FactValue read_fact(const Json& json) {
  if (json.is_array()) return fact_list(json);
  if (json.is_string()) return json.get<std::string>();
  if (json.is_number_integer()) return json.get<int>();
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

void JsonReader::constant(const char* key, const char* text) {
  std::string found = text;
  later(key, found);
  if (found != text) errors_.add(at(key), "expected \"" + std::string(text) + "\"");
}

const Json* JsonReader::find(const char* key) const {
  const auto found = object_.find(key);
  return found == object_.end() ? nullptr : &*found;
}

const Json* JsonReader::required(const char* key) {
  const Json* found = find(key);
  if (!found) errors_.add(at(key), "missing");
  return found;
}

bool JsonReader::is_list(const Json& json, const JsonPath& path, std::size_t size) {
  if (json.is_array() && json.size() == size) return true;
  errors_.add(path, "expected a list of " + std::to_string(size));
  return false;
}

void JsonReader::read_value(const Json& json, const JsonPath& path, bool& value) {
  if (!json.is_boolean()) return errors_.add(path, "expected true or false");
  value = json.get<bool>();
}

void JsonReader::read_value(const Json& json, const JsonPath& path, double& value) {
  if (!json.is_number() && !json.is_null()) return errors_.add(path, "expected a number");
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
  if (std::abs(value) > largest_number) errors_.add(path, "expected a number of a machine, found one beyond 1e100");
}

void JsonReader::read_value(const Json& json, const JsonPath& path, std::string& value) {
  if (!json.is_string()) return errors_.add(path, "expected a text");
  value = json.get<std::string>();
}

std::optional<std::uint64_t> JsonReader::read_unsigned(const Json& json, const JsonPath& path, std::uint64_t max) {
  if (json.is_number_unsigned() && json.get<std::uint64_t>() <= max) return json.get<std::uint64_t>();
  errors_.add(path, "expected a whole number");
  return {};
}

std::optional<std::int64_t> JsonReader::read_integer(const Json& json, const JsonPath& path, std::int64_t min,
                                                     std::int64_t max) {
  const bool is_representable = !json.is_number_unsigned() || json.get<std::uint64_t>() <= INT64_MAX;
  if (json.is_number_integer() && is_representable)
    if (const auto value = json.get<std::int64_t>(); min <= value && value <= max) return value;
  errors_.add(path, "expected a whole number");
  return {};
}

void JsonReader::matrix_rows(const char* key, MatrixXd& matrix) {
  matrix_columns(key, matrix);
  matrix.transposeInPlace();
}

void JsonReader::matrix_columns(const char* key, MatrixXd& matrix) {
  std::vector<std::vector<double>> columns;
  (*this)(key, columns);
  const std::size_t rows = columns.empty() ? 0 : columns.front().size();
  if (std::ranges::any_of(columns, [&](const auto& column) { return column.size() != rows; }))
    return errors_.add(at(key), "expected lists of equal length");
  matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    std::ranges::copy(columns[k], matrix.col(static_cast<Eigen::Index>(k)).begin());
}

void JsonReader::read_facts(const Json& json, const JsonPath& path, FactValues& facts) {
  if (!json.is_object()) return errors_.add(path, "expected an object");
  for (const auto& [name, value] : json.items()) {
    if (!is_fact(value)) return errors_.add({&path, name.c_str()}, "expected a number, a text or a list of them");
    facts.set(name, read_fact(value));
  }
}

}  // namespace kinfer::evidence_json
