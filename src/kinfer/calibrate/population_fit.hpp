// Paper 2, section 3: the identification as a search by a population, on the same problem as the least-squares fit.
//
// F(x) = Σ |p_measured − f(x)|² over the believed rows (eq. 11), in a box about the nominal numbers; where earlier
// calibrations give a prior, plus its weighted squares.
#pragma once

#include "kinfer/calibrate/population_options.hpp"
#include "kinfer/calibrate/single_fit.hpp"

namespace kinfer {

/// Excess of the rms error over that of the least-squares optimum at which a search counts as there: what the paper's
/// own result (table 4) leaves.
inline constexpr double papers_excess = 7.45e-6;  // [m]

/// The box about `prepared.start`, one interval a free parameter.
Bounds search_box(const PreparedFit& prepared, const PopulationOptions& options);

/// Searches; the estimate has the covariance of a least-squares fit there. Orientations and distances do not count in
/// eq. (11); an error where the rows hold no points.
Result<Estimate> fit_population(const CalibrateTask& task, const PoseSet& rows, const ParameterChoice& choice,
                                ToleranceScale scale, const PopulationOptions& options, Rng rng,
                                const Observer& observer = {});

/// What a net is worth: iterations to `papers_excess` above `least_squares` from a swarm drawn evenly in the box
/// (cold), from a compact one about the nominal numbers, from one that remembers the earlier result, and from the
/// net's.
Result<std::vector<SearchRun>> side_by_side(const CalibrateTask& task, const PoseSet& rows,
                                            const ParameterChoice& choice, ToleranceScale scale,
                                            const PopulationOptions& options, const Chain& least_squares, Rng rng,
                                            const Observer& observer = {});

/// Evenly drawn particles drawn together about the box's centre: a tenth of its width.
MatrixXd compact_swarm(const Bounds& box, int particles, Rng rng);

/// Evenly drawn particles, the first of them replaced by what is remembered.
MatrixXd remembering_swarm(const Bounds& box, int particles, ConstVectorRef remembered, Rng rng);

/// First iteration at which the best cost was not above the target; −1: never.
int iterations_to(const std::vector<double>& best, double target);

}  // namespace kinfer
