// Optimal experiment design in the Bayesian (MAP) sense: which rows of a Jacobian to measure, when priors hold what
// they do not tell.
//
// Unknowns are counted in their prior standard deviations, rows in their noise, so the information of a design is
//   Λ = I + known + Σ_chosen GᵀG,   Σ = Λ⁻¹.
// Fedorov's exchange (1972): a chosen candidate is taken out and the best of all is put in, until no exchange helps.
#pragma once

#include <functional>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

enum class Criterion {
  tool,   ///< mean square error of the tool over the workspace (I-optimal)
  worst,  ///< largest error of the tool over the workspace (G-optimal)
  d,      ///< volume of the parameters' uncertainty
  a,      ///< sum of their variances
  e,      ///< the worst known combination of them
};

struct DesignProblem {
  MatrixXd rows;     ///< (block · candidates) x unknowns: Jacobians over noise, times prior sd
  int block = 3;     ///< rows of one candidate: 3 (position) or 6 (pose)
  MatrixXd targets;  ///< (3 · places) x unknowns [m]: Jacobians of the tool at the places that matter, times prior sd
  MatrixXd known;    ///< information of what was measured before, unknowns x unknowns; empty: nothing
  std::function<bool(int, int)> too_close{};  ///< two candidates that must not both be chosen; none: all may

  Eigen::Index candidates() const { return rows.rows() / block; }
};

/// Λ of the chosen candidates.
MatrixXd information(const DesignProblem& problem, const std::vector<int>& chosen);

/// Square of the tool's expected error at each place [m²].
VectorXd tool_variances(const DesignProblem& problem, const MatrixXd& covariance);

/// What the criterion minimises; infinity where Λ cannot be inverted.
double objective(const DesignProblem& problem, Criterion criterion, const MatrixXd& information);

/// Candidates added one after the other, each the best beside those before: a nested sequence.
std::vector<int> greedy_design(const DesignProblem& problem, Criterion criterion, int count);

/// Exchange from a greedy start and `starts` random ones; the best is kept. Fewer than `count` where too_close leaves
/// no more.
std::vector<int> best_design(const DesignProblem& problem, Criterion criterion, int count, int starts, int threads,
                             Rng rng);

/// What a pose that is not in the list would show: `block` x unknowns, like the rows of a candidate.
using RowsOf = std::function<MatrixXd(ConstVectorRef pose)>;
/// A pose near the given one, or anywhere, that may be measured; empty: none was found.
using Propose = std::function<VectorXd(ConstVectorRef pose, Rng& rng)>;

/// Each chosen pose (a column) in turn gives way to a proposal where that lowers the criterion. `allowed` may veto a
/// pose because of the others.
MatrixXd refined_design(const DesignProblem& problem, Criterion criterion, MatrixXd poses, const RowsOf& rows_of,
                        const Propose& propose, const std::function<bool(const MatrixXd&, Eigen::Index)>& allowed,
                        Rng rng);

/// Candidates that may all be left out of a design of all of them before the criterion rises by the fraction `rise`
/// (D: the variances, on geometric average); ascending.
std::vector<int> superfluous(const DesignProblem& problem, Criterion criterion, double rise);

}  // namespace kinfer
