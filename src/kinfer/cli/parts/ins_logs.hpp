// SPDX-License-Identifier: Apache-2.0
// Input of the verbs that read INS recordings.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/common.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::cli {

/// Which files, and how they are read.
struct InsLogSource {
  const std::vector<std::string>& files;
  const std::string& columns;              ///< map of foreign columns; empty: none
  const std::vector<std::string>& topics;  ///< of robot logs; empty: all
};

/// All files as one recording, with a progress line. An error if a sensor lacks specific force or angular rate.
Result<InsRecording> read_ins_logs(const InsLogSource& source, const CommonOptions& common);

/// A recording with its certain faults corrected, and what was found.
struct DiagnosedLogs {
  InsRecording recording;
  std::vector<Finding> findings{};
};
Result<DiagnosedLogs> read_diagnosed_logs(const InsLogSource& source, const CommonOptions& common);

/// --columns MAP.toml and --topic NAME of INS logs.
void add_log_options(CLI::App& verb, std::string& columns, std::vector<std::string>& topics);

}  // namespace kinfer::cli
