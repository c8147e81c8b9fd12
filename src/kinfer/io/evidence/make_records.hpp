// SPDX-License-Identifier: Apache-2.0
// Records that several kinds of evidence hold, made of the facts.
#pragma once

#include <vector>

#include "kinfer/evidence/facts/records.hpp"

namespace kinfer {

std::vector<FindingRecord> finding_records(const std::vector<Finding>& findings);

/// With the version of this program.
ProvenanceRecord provenance_record(const Provenance& provenance);

}  // namespace kinfer
