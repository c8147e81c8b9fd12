// SPDX-License-Identifier: Apache-2.0
// The report on an identification.
#pragma once

#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/report/parts/page.hpp"

namespace kinfer::report {

Page identification_page(const IdentificationEvidence& evidence);

}  // namespace kinfer::report
