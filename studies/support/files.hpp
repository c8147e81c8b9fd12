// SPDX-License-Identifier: Apache-2.0
// Public measured sets, each in its own file format, as pose sets.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::study {

/// The project's own nominal model and column map, and one of the two series.
Chain ur10_chain();
PoseSet ur10_series(const std::string& folder, const std::string& file, const Chain& chain);

/// Ball-in-socket rows of one arm at the named tool positions; sockets are called "position/hole".
Chain mukca_chain(const std::string& folder);
PoseSet mukca_rows(const std::string& folder, const std::string& arm, const std::vector<std::string>& positions,
                   const Chain& chain);

/// Two axes of unknown geometry, roughly at right angles.
Chain positioner_chain();
PoseSet positioner_rows(const std::string& folder, const Chain& chain);

Chain fr3_chain();
PoseSet fr3_rows(const std::string& folder, const Chain& chain);

}  // namespace kinfer::study
