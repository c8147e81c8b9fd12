// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics of full poses inside joint limits, from random starts, beside Orocos KDL's Levenberg-Marquardt
// with restarts. Items are poses.
#include <benchmark/benchmark.h>

#include <array>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/motion/reach.hpp"
#include "paper2_case.hpp"
#include "peers/orocos_kdl.hpp"

namespace kinfer::bench {
namespace {

constexpr double limit = 2.8;  // [rad] of every joint
constexpr int targets = 500, most_starts = 100;

Chain limited_chain() {
  Chain chain = paper2_case().nominal;
  for (Joint& joint : chain.joints) joint.lower = -limit, joint.upper = limit;
  return chain;
}

VectorXd random_posture(Rng rng) {
  VectorXd q(6);
  for (double& number : q) number = rng.uniform(-limit, limit);
  return q;
}

void reach_full_poses(benchmark::State& state) {
  const Chain chain = limited_chain();
  const motion::ReachSolver solver(chain, {});
  int reached = 0, tried = 0;
  for (auto _ : state)
    for (std::uint64_t k = 0; k < targets; ++k, ++tried) {
      const Pose tool = forward(chain, random_posture(Rng(1).stream(k)));
      reached += solver.solve({tool.position, FullGoal{tool.rotation}}, random_posture(Rng(2).stream(k))).status ==
                 ReachStatus::reached;
    }
  KINFER_EXPECT(reached == tried, "{} of {} poses are reached", reached, tried);
  state.SetItemsProcessed(state.iterations() * targets);
}
BENCHMARK(reach_full_poses);

void kdl_inverse_with_restarts(benchmark::State& state) {
  const Chain chain = limited_chain();
  KdlChain kdl(paper2_case().start.data());
  int reached = 0, tried = 0;
  for (auto _ : state)
    for (std::uint64_t k = 0; k < targets; ++k, ++tried) {
      const Pose tool = forward(chain, random_posture(Rng(1).stream(k)));
      std::array<double, 12> pose{};
      for (int i = 0; i < 9; ++i) pose[static_cast<std::size_t>(i)] = tool.rotation(i / 3, i % 3);
      for (int i = 0; i < 3; ++i) pose[static_cast<std::size_t>(9 + i)] = tool.position[i];
      VectorXd start = random_posture(Rng(2).stream(k)), q(6);
      for (std::uint64_t again = 0; again < most_starts; ++again) {
        if (kdl.inverse(start.data(), pose.data(), limit, q.data())) {
          ++reached;
          break;
        }
        start = random_posture(Rng(3).stream(k).stream(again));
      }
    }
  KINFER_EXPECT(reached > 99 * tried / 100, "{} of {} poses are reached", reached, tried);
  state.SetItemsProcessed(state.iterations() * targets);
}
BENCHMARK(kdl_inverse_with_restarts);

}  // namespace
}  // namespace kinfer::bench
