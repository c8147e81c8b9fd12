// SPDX-License-Identifier: Apache-2.0
// Rows of a tracked machine to a file or standard output.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/io/tracking/track_rows.hpp"

namespace kinfer::cli {

enum class RowFormat { csv, json_lines };

class TrackOutput {
 public:
  TrackOutput(TrackRowWriter writer, RowFormat format) : writer_(std::move(writer)), format_(format) {}
  ~TrackOutput();
  TrackOutput(const TrackOutput&) = delete;
  TrackOutput& operator=(const TrackOutput&) = delete;

  /// An empty path: standard output.
  Result<void> open(const std::filesystem::path& path);
  void add(const TrackState& state);
  void flush();
  /// An error where not all rows could be written.
  Result<void> close();

 private:
  TrackRowWriter writer_;
  RowFormat format_;
  std::FILE* file_ = nullptr;
  std::string name_;
  std::string buffer_;
};

}  // namespace kinfer::cli
