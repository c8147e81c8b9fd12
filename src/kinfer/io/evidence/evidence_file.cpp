// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/evidence_file.hpp"

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/evidence/json/shared_fields.hpp"
#include "kinfer/io/evidence/track_json.hpp"

namespace kinfer {
namespace evidence_json {

Result<Json> parse_evidence(std::string_view text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return error("evidence.json: not a JSON object");
  return json;
}

}  // namespace evidence_json

Result<Evidence> read_evidence(std::string_view text) {
  KINFER_TRY(json, evidence_json::parse_evidence(text));
  const auto found = json.find("kind");
  const std::string kind = found != json.end() && found->is_string() ? found->get<std::string>() : "";
  if (kind == "calibrate") return read_calibration_evidence(text);
  if (kind == "identify") return read_identification_evidence(text);
  if (kind == "track") return read_track_run(text);
  if (kind == "frames") return read_frames_evidence(text);
  return error("evidence.json: there is no kind '{}'", kind);
}

}  // namespace kinfer
