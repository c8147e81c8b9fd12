// SPDX-License-Identifier: Apache-2.0
// The summaries of results, for the table of a fleet.
#pragma once

#include <map>
#include <string>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/verification.hpp"
#include "kinfer/evidence/fleet/task_summary.hpp"
#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::fleet {

/// `truth`: the chain that made the measurements, null where it is unknown.
TaskSummary summary_of(const Calibration& calibration, const Chain* truth);
/// `true_lengths`: [m] of the links of the simulated machine, by `length_name`; empty where they are unknown.
TaskSummary summary_of(const Identification& identification, const std::map<std::string, double>& true_lengths);
/// "length_ins2_ins1-ins2_ins2-ins3": of the link on a segment between two joints.
std::string length_name(const std::string& segment, const std::string& from, const std::string& to);

TaskSummary summary_of(const Verification& verification);

}  // namespace kinfer::fleet
