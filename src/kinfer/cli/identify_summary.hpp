// What `kinfer identify` prints when it is done.
#pragma once

#include <string>

#include "kinfer/evidence/identification.hpp"

namespace kinfer::cli {

/// Verdict, who moved when (paper 1, table 3), joints, links, J_RMSE (table 7), notes.
std::string identification_summary(const Identification& found);

}  // namespace kinfer::cli
