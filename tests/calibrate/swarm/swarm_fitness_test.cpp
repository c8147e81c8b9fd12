// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/swarm/swarm_fitness.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

constexpr int poses = 9;

PoseSet random_points(const Chain& chain, Rng rng) {
  PoseSet set;
  set.joints = MatrixXd::NullaryExpr(dof(chain), poses, [&] { return rng.uniform(-1.5, 1.5); });
  for (int row = 0; row < poses; ++row)
    for (int target = -1; target < static_cast<int>(chain.targets.size()); ++target)
      set.points.push_back(
          {.row = row, .target = target, .position = {rng.normal(), rng.normal(), rng.normal()}, .sd = {}});
  return set;
}

MatrixXd candidates(const ParameterSet& set, const Chain& chain, Rng rng) {
  MatrixXd x = pack(set, chain).replicate(1, 4);
  return x.unaryExpr([&](double v) { return v + 0.01 * rng.normal(); });
}

/// Reference: every candidate's chain, every pose by forward kinematics from the base.
double slow_sum(const Chain& nominal, const ParameterSet& set, const PoseSet& data, ConstVectorRef x) {
  double sum = 0.0;
  for (const double error : point_errors(unpack(set, nominal, x), data)) sum += error * error;
  return sum;
}

void expect_equal_to_slow_version(const Chain& chain, const ParameterSet& set) {
  const PoseSet data = random_points(chain, Rng(1));
  const MatrixXd x = candidates(set, chain, Rng(2));
  std::vector<double> sum(x.cols());
  SwarmFitness(chain, set, data).sums(x, sum);
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    EXPECT_NEAR(sum[i], slow_sum(chain, set, data, x.col(i)), 1e-12 * sum[i]) << chain.name;
}

class AnyChain : public ::testing::TestWithParam<Chain> {};
INSTANTIATE_TEST_SUITE_P(SwarmFitness, AnyChain, ::testing::ValuesIn(laws::examples()));

TEST_P(AnyChain, TransformingPointsInwardsGivesTheSumThatPosesGive) {
  Chain chain = GetParam();
  chain.targets = {{"second", Vec3(0.01, 0.2, -0.03)}};
  expect_equal_to_slow_version(chain, geometric_parameters(chain, random_points(chain, Rng(1)), {}));
}

TEST_P(AnyChain, CandidatesMayDifferInGainsAndCompliances) {
  expect_equal_to_slow_version(GetParam(), all_parameters(GetParam(), {}));
}

}  // namespace
}  // namespace kinfer
