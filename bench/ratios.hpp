// SPDX-License-Identifier: Apache-2.0
// Runs all benchmarks, interleaved, and prints medians of CPU time as ratios to the peers.
#pragma once

#include <algorithm>
#include <vector>

namespace kinfer::bench {

/// Statistic of wall-clock times: other load of the machine can only increase them.
inline double fastest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

/// Takes Google Benchmark's options; `--benchmark_out=FILE` writes everything as JSON with machine and flags.
int run_and_print_ratios(int argc, char** argv);

}  // namespace kinfer::bench
