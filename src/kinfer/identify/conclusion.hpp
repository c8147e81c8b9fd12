// The last word on an identification: what was wrong, whether to use it, and one sentence that says both.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer {

/// Fills verdict, use and, with what was found wrong, the notes. All else must be there.
void conclude(Identification& result);

}  // namespace kinfer
