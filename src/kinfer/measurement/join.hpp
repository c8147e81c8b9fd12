// Two pose sets of the same robot as one.
#pragma once

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The rows of `fitted`, labelled train, then those of `kept_aside`, labelled holdout. Lines are each file's own.
PoseSet joined(const PoseSet& fitted, const PoseSet& kept_aside);

}  // namespace kinfer
