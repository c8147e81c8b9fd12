// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/row_source.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include <fmt/ranges.h>

#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/recording/log_rows.hpp"
#include "kinfer/io/recording/possible_times.hpp"

namespace kinfer::cli {
namespace {

constexpr auto poll_period = std::chrono::milliseconds(5);

volatile std::sig_atomic_t interrupted = 0;

/// While it lives, SIGINT and SIGTERM end the reading and not the program.
class InterruptionGuard {
 public:
  InterruptionGuard() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };  // without SA_RESTART: a blocked read returns
    interrupted = 0;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~InterruptionGuard() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
  }
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;

 private:
  struct sigaction interrupt_ {
  }, terminate_{};
};

/// A file or standard input.
class ByteSource {
 public:
  static Result<ByteSource> open(const std::string& path) {
    const int file = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return error("{}: {}", path, std::strerror(errno));
    return ByteSource(file, path == "-" ? "standard input" : path);
  }
  ~ByteSource() {
    if (file_ > STDIN_FILENO) ::close(file_);
  }
  ByteSource(ByteSource&& other) noexcept : file_(std::exchange(other.file_, -1)), name_(std::move(other.name_)) {}
  ByteSource& operator=(ByteSource&&) = delete;

  /// What has arrived, at least one byte unless the end is reached; waits for standard input.
  /// Errors: an input error of the device.
  Result<std::string_view> read() {
    const ssize_t count = ::read(file_, buffer_.data(), buffer_.size());
    if (count < 0 && errno != EINTR) return error("{}: reading stopped with an input error", name_);
    return std::string_view(buffer_.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  }

 private:
  ByteSource(int file, std::string name) : file_(file), name_(std::move(name)) {}
  int file_;
  std::string name_;
  std::array<char, 1 << 16> buffer_{};
};

/// The bytes as they arrive, until the end or an interruption.
Result<std::vector<std::string>> stream(const RowSource& source, const RowSink& sink) {
  const std::string& path = source.logs.front();
  KINFER_TRY(bytes, ByteSource::open(path));
  InsRowReader reader(source.sensors, path == "-" ? "standard input" : path, source.times);
  // Where rows go on arriving, an interrupt is how the user says that this is all; of a whole file it ends the program.
  std::optional<InterruptionGuard> guard;
  if (source.mode == ReadMode::follow || path == "-") guard.emplace();
  while (!guard || !interrupted) {
    KINFER_TRY(piece, bytes.read());
    if (auto done = reader.add(piece, sink.row); !done) return forward_error(done.error());
    if (!piece.empty()) sink.pause();
    if (piece.empty() && (source.mode == ReadMode::once || path == "-")) break;
    if (piece.empty()) std::this_thread::sleep_for(poll_period);
  }
  if (auto done = reader.finish(sink.row); !done) return forward_error(done.error());
  return reader.remarks();
}

bool is_csv(const std::string& path) {
  auto bytes = ByteSource::open(path);
  if (!bytes) return false;
  const auto head = bytes->read();
  return head && is_ins_csv(*head);
}

/// Formats that are read whole, and several logs.
Result<std::vector<std::string>> replay(const RowSource& source, const RowSink& sink) {
  KINFER_TRY(recording, read_ins_logs({source.logs, std::string(), {}}, CommonOptions{.quiet = true}));
  if (auto seconds = expect_seconds(recording); !seconds) return forward_error(seconds.error());
  if (auto done = each_row_of(recording, source.sensors, sink.row); !done)
    return error("{}: {}", fmt::join(source.logs, ", "), done.error().what);
  sink.pause();
  return recording.remarks;
}

}  // namespace

Result<std::vector<std::string>> each_row(const RowSource& source, const RowSink& sink) {
  const bool from_input = std::ranges::find(source.logs, "-") != source.logs.end();
  if (from_input && source.logs.size() > 1) return error("-: standard input cannot be combined with other logs");
  if (source.logs.size() == 1 && (from_input || is_csv(source.logs.front()))) return stream(source, sink);
  if (source.mode == ReadMode::follow)
    return error("--follow: needs a single CSV log or standard input, found {}", fmt::join(source.logs, ", "));
  return replay(source, sink);
}

}  // namespace kinfer::cli
