// SPDX-License-Identifier: Apache-2.0
// A joint of the continuous-time fit as tracking takes it: with the zero, the sense and the axes of the chain's joint
// positions, and with the point in the child nearest to the sensor, because shifting both points along an axis changes
// nothing.
#pragma once

#include <span>

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/identify/geometry/joint_geometry.hpp"

namespace kinfer::identify {

struct TrackedBodies {
  std::vector<TrackingBody> bodies;           ///< in series; parent, sensor and joint are not set
  std::vector<TrackingParameter> parameters;  ///< their indices: of the body in `bodies`
  MatrixXd jacobian;                          ///< of the parameters by the unknowns of the fit's bodies, in their order
};

/// `bodies`, `zero`: of the fit, as for refined_joint; `geometry`: what became of them.
TrackedBodies tracked_bodies(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                             const JointGeometry& geometry);

}  // namespace kinfer::identify
