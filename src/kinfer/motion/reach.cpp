// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/motion/descent.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
using Eigen::Index;

class ReachSolver::Search {
 public:
  Search(const Chain& chain, const ReachOptions& options, const Load& load)
      : options_(options),
        descent_(chain, load, options.position_tolerance, options.angle_tolerance),
        limits_(descent_.limits()) {}

  ReachSolution solve(const ReachTarget& target, const VectorXd& preferred) {
    const ReachTask task(target, options_.tool_axis, descent_.length());
    ReachSolution solution = search(task, preferred);
    const ReachTask::Error left = task.error(descent_.tool(solution.postures.front().q));
    solution.position_error = left.position, solution.angle_error = left.angle;
    return solution;
  }

 private:
  using Steps = Descent::Steps;
  using Attempt = Descent::Attempt;
  static constexpr Steps patient_inside{.of_machine = true, .are_clamped = true, .are_patient = true};

  ReachSolution search(const ReachTask& task, const VectorXd& preferred) {
    ReachSolution solution;
    Attempt closest{preferred, std::numeric_limits<double>::infinity(), false};
    std::optional<VectorXd> beyond;  // reaches the target, outside the limits
    const Rng rng(options_.seed);
    for (int start = 0; start < options_.starts; ++start) {
      solution.starts_used = start + 1;
      Attempt attempt = descent_.run(task, start == 0 ? preferred : draw(rng.stream(static_cast<std::uint64_t>(start))),
                                     steps_of(task, start));
      if (!attempt.converged) {
        if (attempt.error < closest.error) closest = std::move(attempt);
        continue;
      }
      if (is_redundant(task)) descent_.approach(task, preferred, attempt.q);
      if (descent_.has_non_geometric_terms())
        attempt = descent_.run(task, std::move(attempt.q), {.of_machine = true, .are_patient = true});
      if (!attempt.converged) continue;
      descent_.unwind(attempt.q, preferred);
      if (!descent_.is_inside(attempt.q)) {
        if (beyond && violation(attempt.q) >= violation(*beyond)) continue;
        beyond = attempt.q;
        // Other postures of a chain that is not redundant are as far from this one as from any start.
        if (!is_redundant(task) && violation(attempt.q) > thresholds::same_posture) continue;
        attempt = descent_.run(task, attempt.q, {.of_machine = true, .are_clamped = true});
        if (!attempt.converged) continue;
      }
      keep(solution, std::move(attempt.q), preferred);
      if (options_.choice == PostureChoice::first) break;
    }
    if (solution.postures.empty() && beyond && is_redundant(task)) search_inside(task, preferred, solution);
    if (!solution.postures.empty()) {
      solution.status = ReachStatus::reached;
      std::ranges::stable_sort(solution.postures, {}, &Posture::distance);
      if (options_.choice == PostureChoice::nearest) solution.postures.resize(1);
      return solution;
    }
    explain(task, preferred, closest, beyond, solution);
    return solution;
  }

  bool is_redundant(const ReachTask& task) const { return descent_.screws().dof() > task.fixed_freedoms(); }

  /// The free joints of a redundant chain lead back inside the limits where these restrict each step; without them the
  /// way is shorter.
  Steps steps_of(const ReachTask& task, int start) const {
    return {.are_clamped = is_redundant(task) && start % 2 == 1};
  }

  /// Of a redundant chain whose postures were all outside the limits: with patience its free joints lead back inside.
  void search_inside(const ReachTask& task, const VectorXd& preferred, ReachSolution& solution) {
    const Rng rng(options_.seed);
    for (int start = 0; start < options_.starts; ++start) {
      VectorXd q = start == 0 ? preferred : draw(rng.stream(static_cast<std::uint64_t>(start)));
      Attempt attempt = descent_.run(task, std::move(q), patient_inside);
      if (!attempt.converged) continue;
      keep(solution, std::move(attempt.q), preferred);
      if (options_.choice == PostureChoice::first) return;
    }
  }

  /// Why no posture was found, and the one inside the limits that comes closest.
  void explain(const ReachTask& task, const VectorXd& preferred, const Attempt& closest,
               const std::optional<VectorXd>& beyond, ReachSolution& solution) {
    Attempt inside = descent_.run(task, beyond ? *beyond : closest.q, patient_inside);
    if (const Attempt other = descent_.run(task, preferred, patient_inside); other.error < inside.error) inside = other;
    solution.postures = {{inside.q, descent_.distance(inside.q, preferred)}};
    if (inside.converged) {
      solution.status = ReachStatus::reached;
    } else if (beyond) {
      solution.status = ReachStatus::outside_limits;
      for (Index k = 0; k < beyond->size(); ++k)
        if ((*beyond)[k] < limits_.lower[k] || (*beyond)[k] > limits_.upper[k])
          solution.limited_joints.push_back(static_cast<int>(k));
    } else {
      solution.status =
          closest.error < thresholds::near_target ? ReachStatus::near_singular : ReachStatus::out_of_reach;
    }
  }

  double violation(const VectorXd& q) const { return (q - limits_.clamped(q)).cwiseAbs().sum(); }

  void keep(ReachSolution& solution, VectorXd q, const VectorXd& preferred) const {
    for (const Posture& known : solution.postures) {
      VectorXd same = known.q;
      descent_.unwind(same, q);  // half a revolution to either side of the preferred posture is the same
      if (descent_.distance(same, q) < thresholds::same_posture) return;
    }
    const double from_preferred = descent_.distance(q, preferred);
    solution.postures.push_back({std::move(q), from_preferred});
  }

  VectorXd draw(Rng rng) const {
    VectorXd q(descent_.screws().dof());
    for (Index k = 0; k < q.size(); ++k) {
      const bool is_bounded = std::isfinite(limits_.lower[k]) && std::isfinite(limits_.upper[k]);
      const double half = descent_.screws().is_rotational(static_cast<int>(k)) ? std::numbers::pi
                          : is_bounded ? 0.5 * (limits_.upper[k] - limits_.lower[k])
                                       : descent_.length();
      const double lower =
          std::max(limits_.lower[k], std::isfinite(limits_.upper[k]) ? limits_.upper[k] - 2.0 * half : -half);
      const double upper = std::min(limits_.upper[k], lower + 2.0 * half);
      q[k] = rng.uniform(lower, upper);
    }
    return q;
  }

  ReachOptions options_;
  Descent descent_;
  const JointLimits& limits_;
};

ReachSolver::ReachSolver(const Chain& chain, const ReachOptions& options, const Load& load)
    : search_(std::make_unique<Search>(chain, options, load)) {
  KINFER_EXPECT(options.starts > 0 && dof(chain) > 0, "{} starts for {} joints", options.starts, dof(chain));
}
ReachSolver::~ReachSolver() = default;
ReachSolver::ReachSolver(ReachSolver&&) noexcept = default;

ReachSolution ReachSolver::solve(const ReachTarget& target, const VectorXd& preferred) const {
  return search_->solve(target, preferred);
}

std::vector<ReachSolution> reach(const Chain& chain, const std::vector<ReachTarget>& targets, const MatrixXd& preferred,
                                 const ReachOptions& options, int threads) {
  KINFER_EXPECT(preferred.rows() == dof(chain), "{} joint positions for {} joints", preferred.rows(), dof(chain));
  std::vector<ReachSolution> solutions(targets.size());
  constexpr std::size_t block = 64;  // targets of one solver, whose preparation costs as much as a few of them
  parallel_for((targets.size() + block - 1) / block, threads, [&](std::size_t b) {
    const ReachSolver solver(chain, options);
    for (std::size_t i = b * block; i < std::min(targets.size(), (b + 1) * block); ++i)
      solutions[i] = solver.solve(targets[i], preferred.col(preferred.cols() == 1 ? 0 : static_cast<Index>(i)));
  });
  return solutions;
}

std::vector<ReachSolution> reach_in_sequence(const Chain& chain, const std::vector<ReachTarget>& targets,
                                             VectorXd preferred, const ReachOptions& options) {
  const ReachSolver solver(chain, options);
  std::vector<ReachSolution> solutions;
  for (const ReachTarget& target : targets) {
    solutions.push_back(solver.solve(target, preferred));
    if (solutions.back().status == ReachStatus::reached) preferred = solutions.back().postures.front().q;
  }
  return solutions;
}

VectorXd middle_posture(const Chain& chain) {
  const JointLimits limits = joint_limits(chain);
  VectorXd q = VectorXd::Zero(limits.lower.size());
  for (Index k = 0; k < q.size(); ++k) {
    if (std::isfinite(limits.lower[k]) && std::isfinite(limits.upper[k]))
      q[k] = 0.5 * (limits.lower[k] + limits.upper[k]);
    else
      q[k] = std::clamp(0.0, limits.lower[k], limits.upper[k]);
  }
  return q;
}

}  // namespace kinfer::motion
