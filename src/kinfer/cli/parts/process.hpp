// SPDX-License-Identifier: Apache-2.0
// The program as a process: signals, standard streams, bounded time and memory.
#pragma once

namespace kinfer::cli {

/// Called once, before anything else. An interrupt (SIGINT, SIGTERM, SIGHUP) removes what is not complete and ends the
/// program with 128 + signal. Standard streams that are closed are opened as /dev/null, so that no result file takes
/// their place.
void prepare_process();

/// Raises the limits of the stack, of threads as well, to the usual 8 MB as far as that is allowed. False, with a
/// sentence on standard error, where less than 1 MB is left.
bool enlarge_stack();

struct ProcessLimits {
  double memory = 0.0;  ///< [GB]; 0: unlimited
  double time = 0.0;    ///< [s]; 0: unlimited
};
/// Those that were set by the two functions below.
ProcessLimits process_limits();

/// Memory of this process in GB, beyond which it ends with a sentence; 0: unlimited.
void limit_memory(double gigabytes);

/// Called in a catch clause: prints the sentence of what was thrown and returns the exit code. Memory that ran out and
/// what the file system denies are the user's to mend; everything else is an internal error.
int code_of_exception();

/// Time of this process in s, after which it ends with a sentence and exit code 2, and leaves nothing behind; 0:
/// unlimited.
void limit_time(double seconds);

/// False, and a sentence on standard error, where what was printed did not arrive: a full disk.
bool flush_standard_output();

}  // namespace kinfer::cli
