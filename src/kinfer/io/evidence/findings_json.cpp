// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/findings_json.hpp"

#include "kinfer/io/evidence/json/shared_fields.hpp"
#include "kinfer/io/evidence/make_records.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer {

std::string format_findings(const std::vector<Finding>& findings) {
  return dump_json(evidence_json::JsonWriter::json_of(finding_records(findings)), 1);
}

}  // namespace kinfer
