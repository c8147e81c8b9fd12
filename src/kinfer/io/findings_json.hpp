// The doctor's findings as JSON: kind, severity, rows (from 0), lines, sentence, suggestion, applied.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/findings.hpp"

namespace kinfer {

std::string findings_json(const std::vector<Finding>& findings);

}  // namespace kinfer
