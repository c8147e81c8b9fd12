// SPDX-License-Identifier: Apache-2.0
// The published schema holds for what is written, and refuses what is not.
#include "kinfer/io/evidence/evidence_schema.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using Json = nlohmann::ordered_json;

bool is_of_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == "null" && value.is_null();
}

/// What breaks the schema first, with its path; empty: nothing. The keywords that the schema uses, and no others.
std::string violation(const Json& value, const Json& schema, const std::string& path = "") {
  for (const auto& [key, rule] : schema.items()) {
    if (key == "type") {
      const auto types = rule.is_array() ? rule : Json::array({rule});
      if (std::none_of(types.begin(), types.end(), [&](const Json& t) { return is_of_type(value, t); }))
        return path + ": not of type " + rule.dump();
    } else if (key == "const") {
      if (value != rule) return path + ": not " + rule.dump();
    } else if (key == "enum") {
      if (std::find(rule.begin(), rule.end(), value) == rule.end()) return path + ": no name of " + rule.dump();
    } else if (key == "anyOf" || key == "oneOf") {
      const auto fits = std::count_if(rule.begin(), rule.end(),
                                      [&](const Json& choice) { return violation(value, choice, path).empty(); });
      if (key == "anyOf" ? fits == 0 : fits != 1) return path + ": fits " + std::to_string(fits) + " choices";
    } else if (key == "properties") {
      for (const auto& [name, of] : rule.items())
        if (value.contains(name))
          if (auto wrong = violation(value[name], of, path + "." + name); !wrong.empty()) return wrong;
    } else if (key == "additionalProperties") {
      for (const auto& [name, member] : value.items())
        if (auto wrong = violation(member, rule, path + "." + name); !wrong.empty()) return wrong;
    } else if (key == "required") {
      for (const Json& name : rule)
        if (!value.contains(name.get<std::string>())) return path + ": lacks " + name.get<std::string>();
    } else if (key == "items") {
      for (std::size_t i = 0; i < value.size(); ++i)
        if (auto wrong = violation(value[i], rule, path + "[" + std::to_string(i) + "]"); !wrong.empty()) return wrong;
    } else if (key == "minItems" || key == "maxItems") {
      if (value.size() != rule.get<std::size_t>()) return path + ": not of size " + rule.dump();
    } else if (key != "$schema" && key != "title" && key != "description") {
      return "the schema has an unknown keyword: " + key;
    }
  }
  return "";
}

std::vector<Json> every_evidence() {
  return {
      calibration_json(calibration_evidence(rich_calibration(), rich_provenance())),
      calibration_json(calibration_evidence(Calibration{}, {})),
      identification_json(identification_evidence(rich_identification(), rich_provenance())),
      identification_json(identification_evidence(Identification{}, {})),
      Json::parse(format_frames_evidence(frames_evidence(rich_frames()))),
  };
}

TEST(EvidenceSchema, IsThePublishedOne) {
  std::ifstream file(KINFER_SOURCE_DIR "/docs/evidence.schema.json");
  std::ostringstream published;
  published << file.rdbuf();
  EXPECT_EQ(published.str(), format_evidence_schema()) << "kinfer report --schema > docs/evidence.schema.json";
}

TEST(EvidenceSchema, HoldsForWhatIsWritten) {
  const Json schema = Json::parse(format_evidence_schema());
  for (const Json& evidence : every_evidence()) {
    EXPECT_EQ(violation(evidence, schema), "") << evidence["kind"];
    for (const Json& kind : schema["oneOf"])
      if (kind["properties"]["kind"]["const"] == evidence["kind"]) {
        EXPECT_EQ(violation(evidence, kind), "");
      }
  }
}

TEST(EvidenceSchema, NamesEveryMemberThatIsWritten) {
  const Json schema = Json::parse(format_evidence_schema());
  for (const Json& evidence : every_evidence())
    for (const Json& kind : schema["oneOf"])
      if (kind["properties"]["kind"]["const"] == evidence["kind"])
        for (const auto& [name, member] : evidence.items()) EXPECT_TRUE(kind["properties"].contains(name)) << name;
}

TEST(EvidenceSchema, RefusesMissingMembersAndOtherTypes) {
  const Json schema = Json::parse(format_evidence_schema());
  const Json sound = every_evidence().front();
  Json altered = sound;
  altered.erase("sigma");
  EXPECT_NE(violation(altered, schema), "");
  altered = sound;
  altered["sigma"] = "small";
  EXPECT_NE(violation(altered, schema), "");
  altered = sound;
  altered["usability"] = "perhaps";
  EXPECT_NE(violation(altered, schema), "");
  altered = sound;
  altered["kind"] = "identify";
  EXPECT_NE(violation(altered, schema), "");
}

}  // namespace
}  // namespace kinfer::test
