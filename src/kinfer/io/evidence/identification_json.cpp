// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/identification_json.hpp"

#include "kinfer/io/evidence/json/identification_fields.hpp"
#include "kinfer/io/evidence/json/motion_fields.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer {
namespace evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, IdentificationEvidence>& e) {
  a.constant("format", format_name);
  a.constant("kind", "identify");
  verdict_fields(a, e.verdict);
  a.later("findings", e.findings);
  a("notes", e.notes);
  a("root", e.root);
  a("joints", e.joints);
  a.later("loops", e.loops);
  a("links", e.links);
  a("dh", e.dh);
  a("chain", e.chain);
  a.later("next", e.next);
  a.later("places", e.places);
  a.later("clocks", e.clocks);
  a.later("forecast", e.forecast);
  a("order", e.order);
  a("fit", e.fit);
  a("search", e.search);
  a("motion", e.motion);
  a.when(e.update.has_value(), "update", e.update);
  a.later("provenance", e.provenance);
}

}  // namespace evidence_json

nlohmann::ordered_json identification_json(const IdentificationEvidence& evidence) {
  return evidence_json::JsonWriter::object_of(evidence);
}

std::string format_identification_evidence(const IdentificationEvidence& evidence) {
  return dump_json(identification_json(evidence), 1) + "\n";
}

Result<IdentificationEvidence> read_identification_evidence(std::string_view text) {
  return evidence_json::read_text<IdentificationEvidence>(text);
}

std::string format_identification_headline(const Identification& identification) {
  IdentificationEvidence e = identification_evidence(identification, {});
  e.verdict.parts.reset();
  evidence_json::JsonWriter a;
  verdict_fields(a, e.verdict);
  a("root", e.root);
  a("joints", e.joints);
  a("links", e.links);
  a("fit", e.fit);
  return dump_json(a.json()) + "\n";
}

nlohmann::ordered_json identification_schema() {
  return evidence_json::JsonSchemaWriter::object_schema<IdentificationEvidence>();
}

}  // namespace kinfer
