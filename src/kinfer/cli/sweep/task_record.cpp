// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/task_record.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/text/dump_json.hpp"

namespace kinfer::cli {
namespace {

constexpr const char* record_format = "kinfer-task/1";

}  // namespace

std::string format_task_record(const SweepTask& task, std::uint64_t seed, const TaskRecord& record) {
  const nlohmann::ordered_json json{{"format", record_format},
                                    {"key", task.key},
                                    {"verb", record.verb},
                                    {"arguments", task.arguments},
                                    {"seed", seed},
                                    {"exit_code", record.exit_code},
                                    {"signal", record.signal},
                                    {"processor_class", record.processor_class},
                                    {"sentence", record.sentence}};
  return dump_json(json, 1) + "\n";
}

Result<TaskRecord> parse_task_record(std::string_view text) {
  const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  const auto has = [&](const char* key, auto is_kind) { return json.contains(key) && is_kind(json[key]); };
  const auto is_text = [](const nlohmann::ordered_json& value) { return value.is_string(); };
  const auto is_whole = [](const nlohmann::ordered_json& value) { return value.is_number_integer(); };
  if (!json.is_object() || !has("format", is_text) || json["format"] != record_format || !has("verb", is_text) ||
      !has("exit_code", is_whole))
    return error("task.json: no record of a task");
  TaskRecord record{.verb = json["verb"].get<std::string>(), .exit_code = json["exit_code"].get<int>()};
  if (has("signal", is_whole)) record.signal = json["signal"].get<int>();
  if (has("sentence", is_text)) record.sentence = json["sentence"].get<std::string>();
  if (has("processor_class", is_text)) record.processor_class = json["processor_class"].get<std::string>();
  return record;
}

}  // namespace kinfer::cli
