// SPDX-License-Identifier: Apache-2.0
// Fixtures and mountings of a pose set (sockets, planes, set-ups, arms): adds them to the chain and initialises them.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// A chain whose lists of sockets, planes and mountings are those that the pose set indexes.
struct DataWithFixtures {
  Chain chain;
  PoseSet data;
};

/// Sockets and planes in the data's order (with the position in the chain, where it has one); one mounting for each
/// additional set-up and each other tip that the rows name. Rows without a set-up refer to the chain's own base and
/// tool; where all rows name a set-up, the first one named does. An error names an anchor, tip or arm that the robot
/// file lacks.
Result<DataWithFixtures> with_fixtures(const Chain& chain, const PoseSet& data);

/// `chain` with the sockets and planes that no row of `fitted_rows` touches re-estimated from `evaluated`: sockets at
/// the mean tool point, planes fitted to the tool points.
Chain with_unfitted_fixtures(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& evaluated);

/// `chain` with all sockets and planes initialised from its predicted tool points, as the start of a fit.
Chain with_initial_fixtures(const Chain& chain, const PoseSet& data);

}  // namespace kinfer::calibrate
