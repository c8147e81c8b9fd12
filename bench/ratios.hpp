// Runs all benchmarks, interleaved, and prints medians of CPU time as ratios to the peers.
#pragma once

namespace kinfer::bench {

/// Takes Google Benchmark's options; `--benchmark_out=FILE` writes everything as JSON with machine and flags.
int run_and_print_ratios(int argc, char** argv);

}  // namespace kinfer::bench
