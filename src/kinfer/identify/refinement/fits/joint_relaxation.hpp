// SPDX-License-Identifier: Apache-2.0
// Revolute joints that are not strictly revolute are relaxed to spherical ones.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

namespace kinfer::identify {

/// Of the bodies `revolute_joints`, those whose relaxation gains significantly more than nothing, and more than that of
/// the others: what all of them show comes from the mounts. `gains`: decrease of the log residual, one per body.
std::vector<std::size_t> select_joints_to_relax(const std::vector<std::size_t>& revolute_joints,
                                                const std::vector<double>& gains);

/// The fit with these joints relaxed; unchanged if there are none.
RefinementFit relax_joints(const RefinementTask& task, RefinementFit fitted, const Observer& observer);

}  // namespace kinfer::identify
