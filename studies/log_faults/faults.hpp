// SPDX-License-Identifier: Apache-2.0
// Faults of logs as users make them, injected into simulated ones.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::study::log_faults_study {

struct LogFault {
  std::string name;  ///< "rates in deg/s"
  /// The finding that names it, and no other kind; none: the log is refused.
  std::vector<FindingKind> kinds;
  std::function<void(InsRecording&, Rng)> inject;
};

const std::vector<LogFault>& log_faults();

}  // namespace kinfer::study::log_faults_study
