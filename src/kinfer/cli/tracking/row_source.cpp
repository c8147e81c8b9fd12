// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/row_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
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

/// Log rotation.
enum class Rotation {
  none,
  cut,      ///< the file begins anew; what is read from where the reading stood may be in the middle of a row
  replaced  ///< another one stands in its place
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
  ByteSource(ByteSource&& other) noexcept
      : file_(std::exchange(other.file_, -1)),
        head_(std::move(other.head_)),
        offset_(other.offset_),
        name_(std::move(other.name_)) {}
  ByteSource& operator=(ByteSource&& other) noexcept {
    std::swap(file_, other.file_), std::swap(name_, other.name_);
    head_ = std::move(other.head_), offset_ = other.offset_;
    return *this;
  }

  /// What has arrived, at least one byte unless the end is reached; waits for standard input.
  /// Errors: an input error of the device.
  Result<std::string_view> read() {
    const ssize_t count = ::read(file_, buffer_.data(), buffer_.size());
    if (count < 0 && errno != EINTR) return error("{}: reading stopped with an input error", name_);
    const std::string_view piece(buffer_.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
    head_ += piece.substr(0, std::min(piece.size(), most_head - std::min(most_head, head_.size())));
    offset_ += static_cast<off_t>(piece.size());
    return piece;
  }

  Rotation rotation() const {
    struct stat open {
    }, named{};
    if (file_ == STDIN_FILENO || ::fstat(file_, &open) != 0) return Rotation::none;
    if (S_ISREG(open.st_mode) && (open.st_size < offset_ || !begins_as_read())) return Rotation::cut;
    const bool is_same =
        ::stat(name_.c_str(), &named) != 0 || (named.st_ino == open.st_ino && named.st_dev == open.st_dev);
    return is_same ? Rotation::none : Rotation::replaced;
  }

 private:
  static constexpr std::size_t most_head = 4096;  // a header and a row, whose time tells files apart

  ByteSource(int file, std::string name) : file_(file), name_(std::move(name)) {}

  /// A file that was cut may have grown beyond what was read before.
  bool begins_as_read() const {
    std::array<char, most_head> now;
    const ssize_t count = ::pread(file_, now.data(), head_.size(), 0);
    return count >= 0 && std::string_view(now.data(), static_cast<std::size_t>(count)) == head_;
  }

  int file_;
  std::string head_;  // its first bytes
  off_t offset_ = 0;  ///< bytes read
  std::string name_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
};

/// Rows of a file that may begin anew while it is followed; of all of them the times increase.
class RowStream {
 public:
  RowStream(const RowSource& source, const RowSink& sink)
      : source_(source), sink_(sink), name_(source.logs.front() == "-" ? "standard input" : source.logs.front()) {}

  Result<void> add(std::string_view piece) { return reader_.add(piece, row_); }

  Result<void> finish() { return reader_.finish(row_); }

  /// What stood in the file is complete, and read; a line that was cut is left out.
  void begin_anew() {
    remarks_.push_back(fmt::format("{}: the log began anew after {:.3f} s and was followed on", name_, last_time_));
    reader_ = InsRowReader(source_.sensors, name_, source_.times);
    is_continued_ = true;
  }

  std::vector<std::string> remarks() const {
    std::vector<std::string> all = remarks_;
    all.insert(all.end(), reader_.remarks().begin(), reader_.remarks().end());
    return all;
  }

 private:
  Result<void> pass_on(const InsRow& row) {
    if (is_continued_ && source_.times == RowTimes::increasing && row.time <= last_time_)
      return error("{}: the log began anew, and its time with it: {:.3f} s after {:.3f} s; track it as another run",
                   name_, row.time, last_time_);
    is_continued_ = false;
    last_time_ = row.time;
    return sink_.row(row);
  }

  const RowSource& source_;
  const RowSink& sink_;
  std::string name_;
  InsRowReader reader_{source_.sensors, name_, source_.times};
  InsRowReader::Sink row_ = [this](const InsRow& row) { return pass_on(row); };
  std::vector<std::string> remarks_;  // of files that ended
  bool is_continued_ = false;         // another file's rows are to come
  double last_time_ = 0.0;            // [s]
};

/// The bytes as they arrive, until the end or an interruption.
Result<std::vector<std::string>> stream(const RowSource& source, const RowSink& sink) {
  const std::string& path = source.logs.front();
  KINFER_TRY(bytes, ByteSource::open(path));
  RowStream rows(source, sink);
  // Where rows go on arriving, an interrupt is how the user says that this is all; of a whole file it ends the program.
  std::optional<InterruptionGuard> guard;
  if (source.mode == ReadMode::follow || path == "-") guard.emplace();
  while (!guard || !interrupted) {
    const bool was_replaced = source.mode == ReadMode::follow && bytes.rotation() == Rotation::replaced;
    KINFER_TRY(piece, bytes.read());
    const bool was_cut = source.mode == ReadMode::follow && bytes.rotation() == Rotation::cut;
    if (!was_cut) {
      if (auto done = rows.add(piece); !done) return forward_error(done.error());
      if (!piece.empty()) sink.pause();
      if (!piece.empty()) continue;
      if (source.mode == ReadMode::once || path == "-") break;
      std::this_thread::sleep_for(poll_period);
      if (!was_replaced) continue;  // and read to its end since
    }
    KINFER_TRY(next, ByteSource::open(path));
    bytes = std::move(next);
    rows.begin_anew();
  }
  if (auto done = rows.finish(); !done) return forward_error(done.error());
  return rows.remarks();
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
