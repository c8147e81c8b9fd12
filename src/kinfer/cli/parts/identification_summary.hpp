// SPDX-License-Identifier: Apache-2.0
// Summary printed by `kinfer identify`.
#pragma once

#include <string>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::cli {

/// Verdict, which sensors moved when (paper 1, table 3), joints, links, J_RMSE (table 7), notes.
std::string identification_summary(const Identification& found);

}  // namespace kinfer::cli
