// SPDX-License-Identifier: Apache-2.0
// Precision of an identified revolute joint: the Cramér-Rao bound of its ten parameters, with the noise level estimated
// from the residuals.
//
// Random errors only: systematic errors of the filter, the smoothing or the frozen chain before the joint are not
// included.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/geometry/joint_geometry.hpp"

namespace kinfer::identify {

struct JointPrecision {
  JointStandardDeviation sd;
  std::vector<Vec3> unobservable_in_parent,
      unobservable_in_child;            ///< unit, in the sensor frames: unobservable lever directions
  std::vector<DhNumbers> canonical_sd;  ///< of the joint's DH rows; empty: not estimated
};

/// `angle`: joint angle at each row, with its derivatives. `rows`: those that were fitted.
JointPrecision revolute_precision(const JointGeometry& revolute, const std::vector<FrameState>& parent,
                                  const std::vector<FrameState>& child, const JointSignal& angle,
                                  const std::vector<std::size_t>& rows);

}  // namespace kinfer::identify
