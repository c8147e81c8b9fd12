// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/deployment/compensation.hpp"

#include <algorithm>

namespace kinfer {

CompensationSummary summarise(const std::vector<CompensatedJoints>& rows) {
  CompensationSummary summary{.rows = static_cast<int>(rows.size())};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    summary.worst_residual = std::max(summary.worst_residual, rows[i].residual);
    if (rows[i].status != InverseStatus::reached) summary.unreached.push_back(static_cast<int>(i));
  }
  return summary;
}

}  // namespace kinfer
