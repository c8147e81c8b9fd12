// Pose accuracy and repeatability as ISO 9283 defines them, from the rows of a pose set.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// One commanded pose: the rows whose readings agree to 1e-4 rad or 0.01 mm.
struct PoseAccuracy {
  std::vector<int> rows;
  double accuracy_before = 0.0;  ///< AP [m]: distance of the measurements' middle from where `before` has the tool
  double accuracy_after = 0.0;   ///< AP [m] by `after`
  std::optional<double>
      repeatability;  ///< RP [m]: mean distance from the middle + 3 sd of it; where rows repeat a pose
};

/// In the order of each pose's first row; rows without a measured tool point are left out.
std::vector<PoseAccuracy> pose_accuracy(const Chain& before, const Chain& after, const PoseSet& data);

}  // namespace kinfer
