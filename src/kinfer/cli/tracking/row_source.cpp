// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/row_source.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include <fmt/ranges.h>

#include "kinfer/cli/parts/ins_logs.hpp"
#include "kinfer/io/files/growing_file.hpp"
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
  KINFER_TRY(bytes, GrowingFile::open(path));
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
    KINFER_TRY(next, GrowingFile::open(path));
    bytes = std::move(next);
    rows.begin_anew();
  }
  if (auto done = rows.finish(); !done) return forward_error(done.error());
  return rows.remarks();
}

bool is_csv(const std::string& path) {
  auto bytes = GrowingFile::open(path);
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
