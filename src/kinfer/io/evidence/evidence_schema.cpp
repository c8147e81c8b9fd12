// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/evidence_schema.hpp"

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/evidence/track_json.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer {

std::string format_evidence_schema() {
  const nlohmann::ordered_json schema{
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "evidence.json of kinfer"},
      {"description",
       "SI units and radians unless a name says otherwise; null stands for a number that is not finite."},
      {"oneOf", {calibration_schema(), identification_schema(), track_schema(), frames_schema()}}};
  return dump_json(schema, 1) + "\n";
}

}  // namespace kinfer
