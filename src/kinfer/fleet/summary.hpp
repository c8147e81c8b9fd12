// SPDX-License-Identifier: Apache-2.0
// The summaries of results, for the table of a fleet.
#pragma once

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/verification.hpp"
#include "kinfer/evidence/fleet/task_summary.hpp"
#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::fleet {

/// `truth`: the chain that made the measurements, null where it is unknown.
TaskSummary summary_of(const Calibration& calibration, const Chain* truth);
TaskSummary summary_of(const Identification& identification);
TaskSummary summary_of(const Verification& verification);

}  // namespace kinfer::fleet
