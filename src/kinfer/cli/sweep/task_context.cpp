// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/task_context.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "kinfer/fleet/summary.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer::cli {
namespace {

TaskContext& task_context() {
  static TaskContext context;  // set once in each process
  return context;
}

bool is_task() {
  return !task_context().folder.empty();
}

/// Of the links in truth.json of `kinfer simulate`.
Result<std::map<std::string, double>> true_lengths(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  const auto links = json.is_object() ? json.find("links") : json.end();
  if (!json.is_object() || links == json.end() || !links->is_array())
    return error("{}: expected truth.json of `kinfer simulate`", path.string());
  std::map<std::string, double> lengths;
  for (const nlohmann::ordered_json& link : *links) {
    const auto text_of = [&](const char* key) {
      return link.is_object() && link.contains(key) && link[key].is_string() ? link[key].get<std::string>() : "";
    };
    if (link.is_object() && link.contains("length_m") && link["length_m"].is_number())
      lengths[fleet::length_name(text_of("segment"), text_of("from"), text_of("to"))] = link["length_m"].get<double>();
  }
  return lengths;
}

Result<void> write_summary(const TaskSummary& summary) {
  const auto& folder = task_context().folder;
  if (summary.information)
    if (auto done = write_text_file(folder / "information.json", format_information(*summary.information)); !done)
      return done;
  return write_text_file(folder / "summary.json", format_task_summary(summary));
}

}  // namespace

void set_task_context(TaskContext context) {
  task_context() = std::move(context);
}

Result<void> write_task_summary(const Calibration& calibration) {
  if (!is_task()) return {};
  std::optional<Chain> truth;
  if (const std::string& path = task_context().truth; !path.empty()) {
    KINFER_TRY(robot, read_robot_toml(path));
    truth = std::move(robot.chain);
  }
  return write_summary(fleet::summary_of(calibration, truth ? &*truth : nullptr));
}

Result<void> write_task_summary(const Identification& identification) {
  if (!is_task()) return {};
  std::map<std::string, double> lengths;
  if (const std::string& path = task_context().truth; !path.empty()) {
    KINFER_TRY(known, true_lengths(path));
    lengths = std::move(known);
  }
  return write_summary(fleet::summary_of(identification, lengths));
}

Result<void> write_task_summary(const Verification& verification) {
  return is_task() ? write_summary(fleet::summary_of(verification)) : Result<void>{};
}

}  // namespace kinfer::cli
