// SPDX-License-Identifier: Apache-2.0
// Verdict on an identification: its faults, whether to use it, and one sentence that summarises both.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer::identify {

/// Sets `verdict` and `use` and appends the findings to `notes`. Everything else must be filled in.
void set_verdict(Identification& result);

}  // namespace kinfer::identify
