// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/ins_logs.hpp"

#include <filesystem>

#include "kinfer/identify/diagnosis/diagnosis.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace kinfer::cli {

Result<InsRecording> read_ins_logs(const std::vector<std::string>& files, const std::string& columns) {
  const std::vector<std::filesystem::path> paths(files.begin(), files.end());
  return columns.empty() ? read_recording(paths) : read_mapped_recording(paths, columns);
}

void add_log_columns_option(CLI::App& verb, std::string& columns) {
  add_text(verb, "--columns", columns,
           "How foreign logs' columns map to kinfer's (docs/formats.md); known formats need none",
           Requirement::optional, "TOML");
}

Result<DiagnosedLogs> read_diagnosed_logs(const std::vector<std::string>& files, const std::string& columns,
                                          int threads) {
  KINFER_TRY(recording, read_ins_logs(files, columns));
  KINFER_TRY(diagnosis, identify::diagnose_log(recording, threads));
  return DiagnosedLogs{diagnosis.mended ? std::move(*diagnosis.mended) : std::move(recording),
                       std::move(diagnosis.findings)};
}

}  // namespace kinfer::cli
