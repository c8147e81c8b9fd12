// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/run_record.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/version.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer::cli {
namespace {

constexpr const char* run_file = "run.json";

std::vector<std::string>& command_line() {
  static std::vector<std::string> words;  // set once for each run
  return words;
}

/// "AMD EPYC 7B13"; empty where the system does not tell.
std::string processor_model() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "";
}

bool lists(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// run.json of the run that wrote the results in a folder, as far as it can be read.
struct EarlierRun {
  std::string verb{};
  std::vector<std::string> outputs{};  ///< empty: of a version that did not list them

  bool may_have_written(const std::string& name) const { return outputs.empty() || lists(outputs, name); }
};

EarlierRun earlier_run(const std::filesystem::path& folder) {
  const auto text = read_text_file(folder / run_file);
  if (!text) return {};
  const auto run = nlohmann::json::parse(*text, nullptr, false);
  EarlierRun earlier;
  if (!run.is_object()) return earlier;
  if (const auto verb = run.find("verb"); verb != run.end() && verb->is_string()) earlier.verb = *verb;
  if (const auto outputs = run.find("outputs"); outputs != run.end() && outputs->is_array())
    for (const auto& name : *outputs)
      if (name.is_string()) earlier.outputs.push_back(name);
  return earlier;
}

/// A name that cannot lead out of the folder, of a file that was not read.
bool can_be_dropped(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<std::string>& inputs) {
  std::error_code failure;
  const std::filesystem::path file = folder / name;
  return name.find('\0') == std::string::npos && file.filename() == name &&
         std::filesystem::is_regular_file(file, failure) && std::ranges::none_of(inputs, [&](const std::string& input) {
           return std::filesystem::equivalent(input, file, failure);
         });
}

}  // namespace

void store_command_line(const std::vector<std::string>& arguments) {
  command_line() = {"kinfer"};
  command_line().insert(command_line().end(), arguments.begin(), arguments.end());
}

RunRecord::RunRecord(std::string verb, const CommonOptions& options)
    : verb_(std::move(verb)), options_(options), begin_(std::chrono::system_clock::now()) {}

void RunRecord::add_input(const std::filesystem::path& path) {
  std::error_code ignored;  // of a name that is empty: reading it says so
  inputs_.push_back(std::filesystem::absolute(path, ignored).string());
}

Result<OutputFolder> RunRecord::open_folder(const std::filesystem::path& path) const {
  const EarlierRun earlier = earlier_run(path);
  if (lists(earlier.outputs, "evidence.json") && earlier.verb != verb_)
    return error("{}: holds the results of `kinfer {}`; give `kinfer {}` a folder of its own", path.string(),
                 earlier.verb, verb_);
  return OutputFolder::make(path);
}

Result<void> RunRecord::write(OutputFolder& folder) const {
  const std::filesystem::path file = folder / run_file;
  const EarlierRun earlier = earlier_run(folder.path());
  const bool is_renewal = earlier.verb == verb_;
  for (const std::string& name : folder.names())
    if (!is_renewal || !earlier.may_have_written(name))
      if (auto other = expect_other_file((folder.path() / name).string(), inputs_); !other) return other;
  for (const std::string& name : earlier.outputs)
    if (is_renewal && !lists(folder.names(), name) && can_be_dropped(folder.path(), name, inputs_)) folder.drop(name);
  const auto end = std::chrono::system_clock::now();
  nlohmann::ordered_json run;
  run["format"] = "kinfer-run/1";
  run["verb"] = verb_;
  run["command"] = command_line();
  run["version"] = version;
  run["compiler"] = compiler;
  run["build"] = build_type;
  run["processor"] = processor_model();
  run["processor_class"] = processor_class();
  run["threads"] = options_.threads > 0 ? options_.threads : hardware_threads();
  run["seed"] = options_.seed;
  run["inputs"] = inputs_;
  run["outputs"] = folder.names();
  run["began"] = fmt::format("{:%FT%TZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(begin_)));
  run["seconds"] = std::chrono::duration<double>(end - begin_).count();
  return write_text_file(file, dump_json(run, 1) + "\n");
}

}  // namespace kinfer::cli
