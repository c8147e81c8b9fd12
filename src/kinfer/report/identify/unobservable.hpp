// SPDX-License-Identifier: Apache-2.0
// Quantities of a machine that are unobservable from the recording, as the report lists them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/identification/identification_evidence.hpp"

namespace kinfer::report {

/// HTML items: what the user may need and the recording does not determine.
std::vector<std::string> uncertain_items(const IdentificationEvidence& evidence);

}  // namespace kinfer::report
