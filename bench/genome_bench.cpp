// SPDX-License-Identifier: Apache-2.0
// One evaluation of a chain of three DH leaves on 1200 samples: the block kernel, the same on an eighth of them, and
// the reference with 4×4 products and differences.
#include <benchmark/benchmark.h>

#include "identify/example_machine.hpp"
#include "kinfer/identify/programming/link_block.hpp"
#include "support/naive_genome.hpp"

namespace {

using namespace kinfer;
using namespace kinfer::identify;

constexpr std::size_t samples = 1200;
constexpr double h = 1e-3;  // [s]

struct Case {
  JointSignal hinge = test::wave(0.6, 0.9, 1.0, samples);
  std::vector<FrameState> parent = test::swinging_parent(test::wave(0.5, 0.7, 0.3, samples));
  std::vector<FrameState> child = propagate(parent, test::general_hinge(), {&hinge, 1});
  std::vector<LinkBlock> blocks = make_link_blocks(parent, child, {&hinge, 1}, test::all_rows(samples));
};

double square(const std::vector<LinkBlock>& blocks, std::size_t count, const std::vector<DhLeaf>& leaves) {
  double sum = 0.0;
  for (std::size_t b = 0; b < count; ++b) {
    const FrameLanes state = blocks[b].propagate(leaves);
    sum += blocks[b].squared_acceleration_error(state) + blocks[b].squared_chord(state);
  }
  return sum;
}

std::vector<test::NaiveSample> naive_samples(const Case& c) {
  const double w = 2.0 * 3.14159265358979323846;
  std::vector<test::NaiveSample> list;
  for (std::size_t row = 0; row < samples; ++row) {
    test::NaiveSample s{{}, {}, c.child[row].acceleration, c.child[row].rotation};
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = 0.01 * static_cast<double>(row) + (static_cast<double>(k) - 1.0) * h;
      s.q[k] = 0.6 * std::sin(w * 0.9 * t + 1.0);
      s.parent[k] = test::naive_leaf({.alpha = 0.4}, 0.0) *
                    test::naive_leaf({.a = -1.3, .theta_signal = 0}, 0.5 * std::sin(w * 0.7 * t + 0.3));
    }
    list.push_back(s);
  }
  return list;
}

void genome_naive(benchmark::State& state) {
  const Case c;
  const auto list = naive_samples(c);
  for (auto _ : state) benchmark::DoNotOptimize(test::naive_square(list, test::general_hinge(), h));
}
BENCHMARK(genome_naive);

void genome_kernel(benchmark::State& state) {
  const Case c;
  const auto leaves = test::general_hinge();
  const std::size_t count = c.blocks.size() / static_cast<std::size_t>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(square(c.blocks, count, leaves));
}
BENCHMARK(genome_kernel)->Arg(1)->Arg(8);

}  // namespace
