// SPDX-License-Identifier: Apache-2.0
// The rows of recorded logs, as whoever follows a machine takes them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer {

/// Rows of a recording's loggers, merged by time: each holds the samples of `sensors`, in this order, that were taken
/// at its time. An error where the recording lacks one.
Result<void> each_row_of(const InsRecording& recording, const std::vector<std::string>& sensors,
                         const InsRowSink& sink);

/// Rows of the logs, one a logger: of a single CSV as it is read (InsRowReader), of others by `each_row_of`. Returns
/// what is remarkable about the logs, one sentence each.
Result<std::vector<std::string>> each_log_row(const std::vector<std::string>& logs,
                                              const std::vector<std::string>& sensors, const InsRowSink& sink);

}  // namespace kinfer
