// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics of random reachable poses of five chains, from random starts and inside limits: share that is
// reached, CPU time of one thread; time of all postures of a pose:
//   ./dev study reach [--poses 2000] [--limit 2.8] [--seed 1]
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/motion/reach.hpp"
#include "laws/example_chains.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"

namespace kinfer::study::reach_study {
namespace {

using Eigen::Index;

constexpr std::uint64_t poses_of_all_postures = 50;

struct NamedChain {
  const char* name;
  Chain chain;
};

std::vector<NamedChain> chains(double limit) {
  std::vector<NamedChain> named{{"six axes, MDH (ER20)", laws::er20()},
                                {"URDF, five joints", laws::urdf_arm()},
                                {"six axes with couplings", laws::coupled()},
                                {"seven axes", laws::seven_r()},
                                {"six compliant axes, 108 kg", laws::compliant()}};
  for (NamedChain& of : named)
    for (Joint& joint : of.chain.joints) joint.lower = -limit, joint.upper = limit;
  return named;
}

VectorXd random_posture(const JointLimits& limits, Rng rng) {
  VectorXd q(limits.lower.size());
  for (Index k = 0; k < q.size(); ++k) q[k] = rng.uniform(limits.lower[k], limits.upper[k]);
  return q;
}

/// [s] of CPU of this thread.
double cpu_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
  std::vector<double> seconds;  // of each pose
  int reached = 0;
};

Times times_of(const Chain& chain, motion::PostureChoice choice, std::uint64_t poses, std::uint64_t seed) {
  const motion::ReachSolver solver(chain, {.choice = choice});
  const JointLimits limits = joint_limits(chain);
  Times times;
  for (std::uint64_t k = 0; k < poses; ++k) {
    const Pose tool = forward(chain, random_posture(limits, Rng(seed).stream(1).stream(k)));
    const VectorXd start = random_posture(limits, Rng(seed).stream(2).stream(k));
    const double began = cpu_time();
    const ReachSolution solution = solver.solve({tool.position, FullGoal{tool.rotation}}, start);
    times.seconds.push_back(cpu_time() - began);
    times.reached += solution.status == ReachStatus::reached;
  }
  return times;
}

void print_row(const NamedChain& of, std::uint64_t poses, std::uint64_t seed) {
  const Times first = times_of(of.chain, motion::PostureChoice::first, poses, seed),
              all = times_of(of.chain, motion::PostureChoice::all, poses_of_all_postures, seed);
  const auto share = [&](auto count) { return 100.0 * static_cast<double>(count) / static_cast<double>(poses); };
  const auto within = std::ranges::count_if(first.seconds, [](double s) { return s <= 1e-3; });
  fmt::print("{:<28}{:>8.2f} %{:>8.2f} %{:>10.1f}{:>10.1f}{:>10.1f} us{:>9.2f} ms\n", of.name, share(first.reached),
             share(within), 1e6 * mean(first.seconds), 1e6 * quantile(first.seconds, 0.5),
             1e6 * quantile(first.seconds, 0.99), 1e3 * mean(all.seconds));
}

}  // namespace
}  // namespace kinfer::study::reach_study

int kinfer::study::run_reach(int argc, char** argv) {
  std::uint64_t poses = 2000, seed = 1;
  double limit = 2.8;
  ArgumentParser parser("Inverse kinematics of random reachable poses, CPU time of one thread");
  parser.add_option("--poses", poses, "of each chain");
  parser.add_option("--limit", limit, "[rad] or [m] of every joint, to both sides");
  parser.add_option("--seed", seed, "of poses and starts");
  if (const auto code = parser.exit_code(argc, argv)) return *code;
  fmt::print("{:<28}{:>10}{:>10}{:>10}{:>10}{:>13}{:>12}\n", "chain", "reached", "in 1 ms", "mean", "median", "99 %",
             "all");
  for (const reach_study::NamedChain& chain : reach_study::chains(limit)) reach_study::print_row(chain, poses, seed);
  return 0;
}
