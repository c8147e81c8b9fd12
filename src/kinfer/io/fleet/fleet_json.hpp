// SPDX-License-Identifier: Apache-2.0
// summary.json of a task, and fleet.json and prior.json of a merge. Numbers have ten significant digits.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer {

std::string format_task_summary(const TaskSummary& summary);
Result<TaskSummary> parse_task_summary(std::string_view text);

/// Everything but the rows, which table.csv holds.
std::string format_fleet(const Fleet& fleet);

std::string format_population(const PopulationPrior& population);
Result<PopulationPrior> read_population(const std::filesystem::path& path);

}  // namespace kinfer
