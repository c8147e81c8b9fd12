// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/ins_logs.hpp"

#include <filesystem>

#include "kinfer/identify/diagnosis/diagnosis.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {

Result<InsRecording> read_ins_logs(const InsLogSource& source, const CommonOptions& common) {
  if (!source.columns.empty() && !source.topics.empty())
    return error("--topic has no effect with --columns, which maps text files");
  const std::vector<std::filesystem::path> paths(source.files.begin(), source.files.end());
  if (!source.columns.empty()) return read_mapped_recording(paths, source.columns);
  ProgressLine progress(common);
  return read_recording(paths, source.topics, progress.observer());
}

void add_log_options(CLI::App& verb, std::string& columns, std::vector<std::string>& topics) {
  add_text(verb, "--columns", columns,
           "How foreign logs' columns map to kinfer's (docs/formats.md); known formats need none",
           Requirement::optional, "TOML");
  add_list(verb, "--topic", topics, "Imu topic of a robot log; may be repeated (default: all)", "NAME");
}

Result<DiagnosedLogs> read_diagnosed_logs(const InsLogSource& source, const CommonOptions& common) {
  KINFER_TRY(recording, read_ins_logs(source, common));
  KINFER_TRY(diagnosis, identify::diagnose_log(recording, common.threads));
  return DiagnosedLogs{diagnosis.mended ? std::move(*diagnosis.mended) : std::move(recording),
                       std::move(diagnosis.findings)};
}

}  // namespace kinfer::cli
