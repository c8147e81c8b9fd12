// SPDX-License-Identifier: Apache-2.0
// Start-up time of the program: `kinfer --version`.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "ratios.hpp"

namespace {

void start_up(benchmark::State& state) {
  for (auto _ : state)
    if (std::system(KINFER_PROGRAM " --version > /dev/null") != 0) state.SkipWithError("kinfer --version failed");
}
BENCHMARK(start_up)->UseRealTime()->ComputeStatistics("fastest", kinfer::bench::fastest);

}  // namespace
