// A joint of the continuous-time fit in the terms of the evidence: axis line in both sensors' frames, standard
// deviations, what cannot be known, canonical DH.
#pragma once

#include "kinfer/estimate/ins_chain.hpp"
#include "kinfer/identify/found_chain.hpp"

namespace kinfer {

struct RefinedJoint {
  FoundJoint found;
  FoundHinge hinge;  ///< geometry with its home at reading `zero`, standard deviations of the canonical numbers
  double stray = 0.0;  ///< [rad] rms angle between the axes of a hinge that was let loose
};

/// `bodies`: one, or the two or three of a universal or spherical joint. `zero` [rad] or [m]: their readings that are
/// called 0. `covariance`: of the bodies' unknowns, one after the other. `ball_axes`: see HingeGeometry. The largest
/// coordinate of a single axis in the parent is positive.
RefinedJoint refined_joint(FoundJointType type, std::span<const InsBody> bodies, std::span<const double> zero,
                           ConstMatrixRef covariance, const Mat3& ball_axes = Mat3::Identity());

}  // namespace kinfer
