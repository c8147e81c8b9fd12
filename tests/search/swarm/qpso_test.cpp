// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/qpso.hpp"

#include <gtest/gtest.h>

#include "search/swarm_problems.hpp"

namespace kinfer {
namespace {

using testing::rastrigin;
using testing::shifted_sphere;

TEST(Qpso, FindsTheMinimumOfAQuadraticIn24Dimensions) {
  const SearchOutcome outcome =
      quantum_swarm(shifted_sphere(24), {.schedule = 400, .budget = {.max_iterations = 600}}, Rng(1));
  EXPECT_LT((outcome.x.array() - 0.3).abs().maxCoeff(), 1e-3);
}

TEST(Qpso, FindsTheGlobalOfManyLocalMinima) {
  const SearchOutcome outcome =
      quantum_swarm(rastrigin(3), {.schedule = 300, .budget = {.max_iterations = 300}}, Rng(1));
  EXPECT_LT(outcome.x.norm(), 1e-4);
}

TEST(Qpso, AContractionAbove178DispersesTheSwarm) {
  // Sun et al.: |x − p| grows without bound in the mean above e^gamma = 1.781; here the bounds limit it.
  const QpsoOptions wide{.contraction = 2.2, .final_contraction = 2.2, .budget = {.max_iterations = 200}};
  const QpsoOptions narrow{.contraction = 0.6, .final_contraction = 0.6, .budget = {.max_iterations = 200}};
  const auto width = [](const SearchOutcome& o) { return (o.final_swarm.colwise() - o.x).cwiseAbs().mean(); };
  EXPECT_GT(width(quantum_swarm(shifted_sphere(5), wide, Rng(1))), 0.3);
  EXPECT_LT(width(quantum_swarm(shifted_sphere(5), narrow, Rng(1))), 1e-6);
}

}  // namespace
}  // namespace kinfer
