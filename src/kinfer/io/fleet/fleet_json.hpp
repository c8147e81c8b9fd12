// SPDX-License-Identifier: Apache-2.0
// summary.json and information.json of a task, and fleet.json and prior.json of a merge. Numbers have ten significant
// digits.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/fleet/fleet.hpp"

namespace kinfer {

/// Without `information`, which is large, of interest for few robots, and has a file of its own: information.json.
std::string format_task_summary(const TaskSummary& summary);
Result<TaskSummary> parse_task_summary(std::string_view text);

std::string format_information(const ParameterInformation& information);
Result<ParameterInformation> parse_information(std::string_view text);

/// Everything but the rows, which table.csv holds.
std::string format_fleet(const Fleet& fleet);

std::string format_population(const PopulationPrior& population);
Result<PopulationPrior> parse_population(std::string_view text, const std::string& name_in_messages);
Result<PopulationPrior> read_population(const std::filesystem::path& path);

}  // namespace kinfer
