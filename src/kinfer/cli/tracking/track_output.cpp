// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/track_output.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

namespace kinfer::cli {

TrackOutput::~TrackOutput() {
  flush();
  if (file_ && file_ != stdout) std::fclose(file_);
}

Result<void> TrackOutput::close() {
  flush();
  if (!file_ || file_ == stdout) return {};  // the program itself asks whether standard output could be written
  const bool failed = std::ferror(file_) != 0;
  if (std::fclose(std::exchange(file_, nullptr)) == 0 && !failed) return {};
  return error("{}: cannot be written: {}", name_, std::strerror(errno));
}

Result<void> TrackOutput::open(const std::filesystem::path& path) {
  name_ = path.string();
  file_ = path.empty() ? stdout : std::fopen(path.c_str(), "wb");
  if (!file_) return error("{}: cannot be written", path.string());
  if (format_ == RowFormat::csv) buffer_ = writer_.header();
  return {};
}

void TrackOutput::add(const TrackState& state) {
  constexpr std::size_t most_buffered = 1 << 18;
  if (format_ == RowFormat::csv)
    writer_.append_csv(state, buffer_);
  else
    writer_.append_json(state, buffer_);
  if (buffer_.size() > most_buffered) flush();
}

void TrackOutput::flush() {
  if (!file_) return;
  std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
  std::fflush(file_);
  buffer_.clear();
}

}  // namespace kinfer::cli
