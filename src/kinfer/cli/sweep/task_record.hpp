// SPDX-License-Identifier: Apache-2.0
// task.json: how a task of a sweep ended.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/io/fleet/manifest.hpp"

namespace kinfer::cli {

struct TaskRecord {
  std::string verb{};
  int exit_code = 0;
  int signal = 0;                 ///< that ended it; 0: none
  std::string sentence{};         ///< what the program said where it failed; empty: nothing
  std::string processor_class{};  ///< processor and kernels
};

std::string format_task_record(const SweepTask& task, std::uint64_t seed, const TaskRecord& record);
Result<TaskRecord> parse_task_record(std::string_view text);

}  // namespace kinfer::cli
