// SPDX-License-Identifier: Apache-2.0
// Runs the program in a process of its own, with bounded time and memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kinfer::fuzz {

struct Limits {
  int cpu_seconds = 20;
  int wall_seconds = 60;
  std::uint64_t memory = std::uint64_t{4} << 30;  ///< [bytes] of address space; 0: unlimited, for sanitizer builds
};

struct ProcessResult {
  int code = -1;           ///< of exit; −1 where a signal ended it
  int signal = 0;          ///< that ended it
  bool timed_out = false;  ///< it used up its time
  double seconds = 0.0;
  std::string out, err;  ///< standard output and standard error
};

/// Runs `program` with `arguments` in `folder`; standard input is empty. At `kill_after` seconds (0: never) it gets
/// `kill_signal`.
ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, const Limits& limits, double kill_after = 0.0,
                          int kill_signal = 9);

std::string read_bytes(const std::filesystem::path& path);

}  // namespace kinfer::fuzz
