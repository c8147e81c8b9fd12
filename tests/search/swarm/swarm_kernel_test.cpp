// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/swarm_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {
namespace {

std::vector<search::SwarmKernel> runnable() {
  std::vector<search::SwarmKernel> list{search::move_particle};
#if defined(__x86_64__)
  if (instruction_set() >= InstructionSet::avx2) list.push_back(search::swarm_avx2);
  if (instruction_set() >= InstructionSet::avx512) list.push_back(search::swarm_avx512);
#endif
  return list;
}

TEST(SwarmKernel, EveryInstructionSetUpdatesByEquations9And10BitForBit) {
  constexpr int dim = 29;  // not a multiple of any number of lanes
  constexpr double w = 0.8, own = 0.5, swarm = 1.25;
  Rng rng(1);
  const auto random = [&] { return VectorXd::NullaryExpr(dim, [&] { return rng.uniform(-1.0, 1.0); }).eval(); };
  const VectorXd x0 = random(), v0 = random(), best = random(), own_best = random();
  const VectorXd lower = VectorXd::Constant(dim, -0.9), upper = VectorXd::Constant(dim, 0.9);
  std::vector<double> pairs(2 * dim);
  rng.uniform(pairs);
  for (const double limit : {0.3, std::numeric_limits<double>::infinity()})
    for (const bool absorbs : {false, true}) {
      const VectorXd max_velocity = VectorXd::Constant(dim, limit);
      const search::SwarmStep step{dim,          w,      own, swarm, best.data(), max_velocity.data(), lower.data(),
                                   upper.data(), absorbs};
      for (const search::SwarmKernel move : runnable()) {
        VectorXd x = x0, v = v0;
        move(step, pairs.data(), own_best.data(), x.data(), v.data());
        for (int d = 0; d < dim; ++d) {
          const double pull = own * pairs[2 * d] * (own_best[d] - x0[d]) + swarm * pairs[2 * d + 1] * (best[d] - x0[d]);
          const double speed = std::clamp(w * v0[d] + pull, -limit, limit), to = x0[d] + speed;
          EXPECT_EQ(x[d], std::clamp(to, -0.9, 0.9));
          EXPECT_EQ(v[d], absorbs && x[d] != to ? 0.0 : speed);
        }
      }
    }
}

}  // namespace
}  // namespace kinfer
