// SPDX-License-Identifier: Apache-2.0
// Optimal experiment design in the Bayesian (MAP) sense: which rows of a Jacobian to measure, given priors on the
// unknowns.
//
// Unknowns are scaled by their prior standard deviations, rows by their noise, so the information of a design is
//   Λ = I + known + Σ_chosen GᵀG,   Σ = Λ⁻¹.
// Fedorov's exchange (1972): a chosen candidate is taken out and the best of all is put in, until no exchange helps.
#pragma once

#include <functional>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/deployment/pose_plan.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::plan {

struct DesignProblem {
  MatrixXd rows;     ///< (block · candidates) x unknowns: Jacobians over noise, times prior sd
  int block = 3;     ///< rows of one candidate: 3 (position) or 6 (pose)
  MatrixXd targets;  ///< (3 · places) x unknowns [m]: Jacobians of the tool over the workspace, times prior sd
  MatrixXd prior_information;                 ///< information of earlier measurements, unknowns x unknowns; empty: none
  std::function<bool(int, int)> too_close{};  ///< two candidates that must not both be chosen; none: all may

  Eigen::Index candidates() const { return rows.rows() / block; }
};

/// Λ of the chosen candidates.
MatrixXd information(const DesignProblem& problem, const std::vector<int>& chosen);

/// Square of the tool's expected error at each place [m²].
VectorXd tool_variances(const DesignProblem& problem, const MatrixXd& covariance);

/// Value of the criterion, to be minimised; infinity where Λ cannot be inverted.
double objective(const DesignProblem& problem, Criterion criterion, const MatrixXd& information);

/// Candidates added one by one, each the best addition to the previous ones: a nested sequence.
std::vector<int> greedy_design(const DesignProblem& problem, Criterion criterion, int count);

/// Exchange from a greedy start and `starts` random ones; the best is kept. Fewer than `count` if too_close leaves no
/// more.
std::vector<int> best_design(const DesignProblem& problem, Criterion criterion, int count, int starts, int threads,
                             Rng rng);

/// Scaled Jacobian of a pose that is not in the list: `block` x unknowns, like the rows of a candidate.
using JacobianRows = std::function<MatrixXd(ConstVectorRef pose)>;
/// A feasible pose near the given one, or anywhere; empty: none was found.
using PoseProposer = std::function<VectorXd(ConstVectorRef pose, Rng& rng)>;

/// Replaces each chosen pose (a column) in turn by a proposal if that lowers the criterion. `allowed(poses, i)` may
/// reject pose i because of the others.
MatrixXd refined_design(const DesignProblem& problem, Criterion criterion, MatrixXd poses, const JacobianRows& rows_of,
                        const PoseProposer& propose, const std::function<bool(const MatrixXd&, Eigen::Index)>& allowed,
                        Rng rng);

/// Candidates that can all be removed from a design of all of them before the criterion rises by the fraction `rise`
/// (D: the variances, on geometric average); ascending.
std::vector<int> find_redundant(const DesignProblem& problem, Criterion criterion, double rise);

}  // namespace kinfer::plan
