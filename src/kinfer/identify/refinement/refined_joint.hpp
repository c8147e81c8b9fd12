// SPDX-License-Identifier: Apache-2.0
// Converts a joint of the continuous-time fit to evidence: axis line in both sensor frames, standard deviations,
// unobservable directions, canonical DH.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/identify/geometry/identified_chain.hpp"

namespace kinfer::identify {

struct RefinedJoint {
  JointEstimate estimate;
  GeometryEstimate solution;    ///< geometry with its home at joint position `zero`, standard deviations of the DH rows
  double axis_deviation = 0.0;  ///< [rad] rms angle between the two axes of a relaxed revolute joint
};

/// `bodies`: one, or several in series. `zero` [rad] or [m]: their joint positions that are defined as 0. `covariance`:
/// of the bodies' unknowns, one after the other. `spherical_axes`: see JointGeometry. The largest coordinate of a
/// single axis in the parent is positive.
RefinedJoint refined_joint(EstimatedJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                           ConstMatrixRef covariance, const Mat3& spherical_axes = Mat3::Identity());

}  // namespace kinfer::identify
