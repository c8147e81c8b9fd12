// SPDX-License-Identifier: Apache-2.0
// evidence.json of `identify` (docs/formats.md, kinfer-evidence/1), written and read. SI throughout; the same bytes for
// the same evidence, and for evidence that was read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification/identification_evidence.hpp"

namespace kinfer {

/// What the file states of an identification: sentences made, drawings rounded.
IdentificationEvidence identification_evidence(const Identification& identification, const Provenance& provenance);

nlohmann::ordered_json identification_json(const IdentificationEvidence& evidence);
std::string format_identification_evidence(const IdentificationEvidence& evidence);

/// Error: the path of the first value that is missing or of another type, and what was expected.
Result<IdentificationEvidence> read_identification_evidence(std::string_view text);

/// One line for `--json`: the verdict and the headline figures.
std::string format_identification_headline(const Identification& identification);

/// JSON Schema of what is written.
nlohmann::ordered_json identification_schema();

}  // namespace kinfer
