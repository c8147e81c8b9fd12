// A joint of the continuous-time fit in the terms of the evidence: axis line in both sensors' frames, standard
// deviations, what cannot be known, canonical DH.
#pragma once

#include "kinfer/estimate/ins_chain.hpp"
#include "kinfer/identify/found_chain.hpp"

namespace kinfer {

struct RefinedJoint {
  FoundJoint found;
  FoundHinge hinge;  ///< geometry with its home at reading `zero`, standard deviations of the canonical numbers
};

/// `covariance`: of the body's unknowns. `zero` [rad] or [m]: the reading that is called 0. The axis' largest
/// coordinate in the parent is positive.
RefinedJoint refined_joint(FoundJointType type, const InsBody& body, double zero, ConstMatrixRef covariance);

}  // namespace kinfer
