// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/make_records.hpp"

#include "kinfer/base/version.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {

std::vector<FindingRecord> finding_records(const std::vector<Finding>& findings) {
  std::vector<FindingRecord> records;
  for (const Finding& finding : findings) {
    records.push_back({finding, words::sentence(finding), words::suggestion(finding)});
    records.back().finding.equivalents.clear();
  }
  return records;
}

ProvenanceRecord provenance_record(const Provenance& provenance) {
  return {std::string(version), provenance.seed, provenance.options, provenance.inputs, provenance.earlier_inputs};
}

}  // namespace kinfer
