// SPDX-License-Identifier: Apache-2.0
// Paper 2, section 3: identification by a swarm search, on the same problem as the least-squares fit.
//
// F(x) = Σ |p_measured − f(x)|² over the inlier rows (eq. 11), in a box about the nominal values; plus the weighted
// squares of the population prior where there is one.
#pragma once

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/problem/swarm_options.hpp"

namespace kinfer::calibrate {

/// A search counts as converged when its rms error exceeds that of the least-squares optimum by less than this: the
/// excess of the paper's own result (table 4).
inline constexpr double paper_excess = 7.45e-6;  // [m]

/// The search box about `prepared.start`, one interval per free parameter.
Bounds make_search_box(const PreparedFit& prepared, const SwarmSearchOptions& options);

/// Runs the search; the estimate has the covariance of a least-squares fit at the solution. Orientations and distances
/// are not part of eq. (11); an error where the rows contain no points.
Result<Estimate> fit_by_swarm(const CalibrationTask& task, const PoseSet& rows, const ParameterChoice& choice,
                              ToleranceScale scale, const SwarmSearchOptions& options, Rng rng,
                              const Observer& observer = {});

/// Compares initial swarms, to show the benefit of a trained network: iterations until `paper_excess` above
/// `least_squares` from a swarm drawn uniformly in the box (cold), a compact one about the nominal values, one that
/// contains the earlier result, and the network's.
Result<std::vector<SearchRun>> swarm_comparison(const CalibrationTask& task, const PoseSet& rows,
                                                const ParameterChoice& choice, ToleranceScale scale,
                                                const SwarmSearchOptions& options, const Chain& least_squares, Rng rng,
                                                const Observer& observer = {});

/// Uniformly drawn particles, contracted about the box's centre to a tenth of its width.
MatrixXd draw_compact_swarm(const Bounds& box, int particles, Rng rng);

/// Uniformly drawn particles, the first of them replaced by `known`.
MatrixXd draw_warm_swarm(const Bounds& box, int particles, ConstVectorRef known, Rng rng);

/// First iteration whose best cost is not above the target; −1: none.
int iterations_until(const std::vector<double>& best, double target);

}  // namespace kinfer::calibrate
