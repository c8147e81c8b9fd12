// SPDX-License-Identifier: Apache-2.0
// Fixtures and mountings of a pose set (set-ups, arms): adds them to the chain and initialises them.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// A chain whose lists of fixtures and mountings are those that the pose set indexes.
struct DataWithFixtures {
  Chain chain;
  PoseSet data;
};

/// Fixtures in the data's order (with the position in the chain, where it has one); one mounting for each
/// additional set-up and each other tip that the rows name. Rows without a set-up refer to the chain's own base and
/// tool; where all rows name a set-up, the first one named does. An error names an anchor, tip or arm that the robot
/// file lacks.
Result<DataWithFixtures> with_fixtures(const Chain& chain, const PoseSet& data);

/// `chain` with the fixtures without a prior that no row of `fitted_rows` refers to estimated from `evaluated`.
Chain with_unfitted_fixtures(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& evaluated);

/// `chain` with all fixtures without a prior initialised from its predicted tool points, as the start of a fit.
Chain with_initial_fixtures(const Chain& chain, const PoseSet& data);

}  // namespace kinfer::calibrate
