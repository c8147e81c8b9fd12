// SPDX-License-Identifier: Apache-2.0
// JSON Schema of evidence.json, made from what writes and reads the file.
#pragma once

#include <string>

namespace kinfer {

/// Of every kind of evidence, with a line break at the end: docs/evidence.schema.json.
std::string format_evidence_schema();

}  // namespace kinfer
