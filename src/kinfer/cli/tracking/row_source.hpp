// SPDX-License-Identifier: Apache-2.0
// Rows of INS logs for verbs that work while the machine does: files, files that still grow, standard input.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/recording/ins_row_reader.hpp"

namespace kinfer::cli {

enum class ReadMode {
  once,   ///< to the end of the file
  follow  ///< at its end waits for more, until the program is interrupted (SIGINT, SIGTERM)
};

struct RowSource {
  std::vector<std::string> logs{};     ///< one a logger; "-": standard input, alone
  std::vector<std::string> sensors{};  ///< whose samples a row holds, in this order
  ReadMode mode = ReadMode::once;
  RowTimes times = RowTimes::increasing;
};

struct RowSink {
  std::function<Result<void>(const InsRow&)> row;
  std::function<void()> pause;  ///< all that arrived was passed on: time to flush
};

/// Returns what is remarkable about the logs, one sentence each. Rows of CSV logs are passed on as they arrive; other
/// formats and several logs are read whole.
Result<std::vector<std::string>> each_row(const RowSource& source, const RowSink& sink);

}  // namespace kinfer::cli
