// SPDX-License-Identifier: Apache-2.0
// What `kinfer inspect --json` says about an INS recording.
#pragma once

#include <string>

#include "kinfer/cli/parts/ins_logs.hpp"

namespace kinfer::cli {

/// Loggers, sensors with rates and rests, remarks, findings, and what is assumed because nothing in the log tells.
std::string recording_json(const DiagnosedLogs& logs);

/// Samples per second of an instrument.
double sample_rate(const InsSensor& sensor, std::span<const double> time, Fault missing);

/// Whether nothing in the recording tells the sign of all accelerometers together.
bool assumes_upward_force(const InsRecording& recording);

}  // namespace kinfer::cli
