// SPDX-License-Identifier: Apache-2.0
// What a verb knows when it runs as a task of a sweep: where its summary goes, and the truth of its data.
#pragma once

#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/verification.hpp"
#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::cli {

struct TaskContext {
  std::filesystem::path folder{};  ///< empty: the program is no task of a sweep
  std::string truth{};             ///< robot file that made the data; empty: unknown
};

/// Of this process; set in the child that runs the task.
void set_task_context(TaskContext context);

/// Writes summary.json, and information.json of a calibration, into the task's folder; nothing where there is none.
Result<void> write_task_summary(const Calibration& calibration);
Result<void> write_task_summary(const Identification& identification);
Result<void> write_task_summary(const Verification& verification);

}  // namespace kinfer::cli
