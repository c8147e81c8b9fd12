// SPDX-License-Identifier: Apache-2.0
// Recommendations after an identification.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::identify {

/// Most useful first. Needs joints, order, forecast and usability.
std::vector<IdentificationAdvice> identification_advice(const Identification& result);

}  // namespace kinfer::identify
