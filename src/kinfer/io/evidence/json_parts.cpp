// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/json_parts.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/base/version.hpp"

namespace kinfer {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json finite_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json values_json(const FactValues& values) {
  Json json = Json::object();
  for (const auto& [key, value] : values) json[key] = std::visit([](const auto& v) { return Json(v); }, value);
  return json;
}

Json provenance_json(const Provenance& provenance) {
  Json inputs = Json::array(), options = Json::object();
  for (const InputFile& input : provenance.inputs) inputs.push_back({{"name", input.name}, {"sha256", input.sha256}});
  for (const auto& [key, value] : provenance.options) options[key] = value;
  return {{"version", version}, {"seed", provenance.seed}, {"options", options}, {"inputs", inputs}};
}

}  // namespace kinfer
