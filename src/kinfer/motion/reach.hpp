// SPDX-License-Identifier: Apache-2.0
// Reach: joint positions at which the tool meets a target, inside the joint limits, for any chain.
//
// From each start damped Gauss-Newton steps are made whose damping is proportional to the squared error (after Sugihara
// 2011, "Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method"). Joint limits do not restrict
// the steps, but of redundant chains those of every other start: revolutions are removed and limits checked at the end,
// and a start that stops improving is left early. The first start is the preferred posture, the others are drawn inside
// the limits.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kinfer/evidence/motion/reach_solution.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/reach_target.hpp"

namespace kinfer::motion {

enum class PostureChoice {
  first,    ///< the first found: the fastest; from the preferred posture where that converges
  nearest,  ///< the nearest of all that were found to the preferred posture
  all,      ///< all that were found, nearest first
};

struct ReachOptions {
  double position_tolerance = 1e-9;  ///< [m]
  double angle_tolerance = 1e-9;     ///< [rad]
  PostureChoice choice = PostureChoice::first;
  int starts = 200;                ///< of the search; more: misses fewer postures
  Vec3 tool_axis = Vec3::UnitZ();  ///< unit, in the tool frame: what AxisGoal and PitchGoal direct
  std::uint64_t seed = 1;          ///< of the drawn starts
};

/// Finds postures of one chain. Movable; `solve` is const, but not to be called by several threads at once.
class ReachSolver {
 public:
  ReachSolver(const Chain& chain, const ReachOptions& options, const Load& load = {});
  ~ReachSolver();
  ReachSolver(ReachSolver&&) noexcept;

  /// `preferred`: dof joint positions. Redundant joints stay as near to them as the target allows.
  ReachSolution solve(const ReachTarget& target, const VectorXd& preferred) const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

/// One solution for each target. Each prefers its column of `preferred` (dof x targets), or the only one.
std::vector<ReachSolution> reach(const Chain& chain, const std::vector<ReachTarget>& targets, const MatrixXd& preferred,
                                 const ReachOptions& options, int threads);

/// The same for targets that follow each other: each prefers the posture found for the one before it, the first
/// `preferred` (dof).
std::vector<ReachSolution> reach_in_sequence(const Chain& chain, const std::vector<ReachTarget>& targets,
                                             VectorXd preferred, const ReachOptions& options);

/// The middle of the joint range; 0 where a joint has no limits.
VectorXd middle_posture(const Chain& chain);

}  // namespace kinfer::motion
