// SPDX-License-Identifier: Apache-2.0
// The loops of a fitted machine as evidence: the closing joint in the frames of its two sensors with standard
// deviations.
#pragma once

#include "kinfer/estimate/continuous/solver/covariance.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/loops/loop_fit.hpp"

namespace kinfer::identify {

/// `joints`: of the unknowns' closures, as JointEstimate; in the order of `loops`. `names`: of the sensors.
std::vector<LoopEstimate> loop_estimates(const std::vector<FoundLoop>& loops, const InsBodies& bodies,
                                         std::vector<JointEstimate> joints, const std::vector<std::string>& names);

/// One finding for each loop.
std::vector<Finding> loop_findings(const std::vector<LoopEstimate>& loops);

}  // namespace kinfer::identify
