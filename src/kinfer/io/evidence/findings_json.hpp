// SPDX-License-Identifier: Apache-2.0
// Findings about a pose set or a recording as JSON: kind, severity, rows (from 0), lines, sentence, suggestion,
// applied, values.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer {

std::string format_findings(const std::vector<Finding>& findings);

}  // namespace kinfer
