#include "kinfer/search/qpso.hpp"

#include <gtest/gtest.h>

#include "search/swarm_problems.hpp"

namespace kinfer {
namespace {

using testing::rastrigin;
using testing::shifted_sphere;

TEST(Qpso, finds_the_lowest_point_of_a_bowl_in_24_dimensions) {
  const Outcome outcome =
      quantum_swarm(shifted_sphere(24), {.schedule = 400, .budget = {.max_iterations = 600}}, Rng(1));
  EXPECT_LT((outcome.x.array() - 0.3).abs().maxCoeff(), 1e-3);
}

TEST(Qpso, finds_the_lowest_of_many_valleys) {
  const Outcome outcome = quantum_swarm(rastrigin(3), {.schedule = 300, .budget = {.max_iterations = 300}}, Rng(1));
  EXPECT_LT(outcome.x.norm(), 1e-4);
}

TEST(Qpso, a_contraction_above_1_78_disperses_the_swarm) {
  // Sun et al.: |x − p| grows without bound in the mean above e^gamma = 1.781; here the walls hold it.
  const QpsoOptions wide{.contraction = 2.2, .final_contraction = 2.2, .budget = {.max_iterations = 200}};
  const QpsoOptions narrow{.contraction = 0.6, .final_contraction = 0.6, .budget = {.max_iterations = 200}};
  const auto width = [](const Outcome& o) { return (o.final_swarm.colwise() - o.x).cwiseAbs().mean(); };
  EXPECT_GT(width(quantum_swarm(shifted_sphere(5), wide, Rng(1))), 0.3);
  EXPECT_LT(width(quantum_swarm(shifted_sphere(5), narrow, Rng(1))), 1e-6);
}

}  // namespace
}  // namespace kinfer
