// SPDX-License-Identifier: Apache-2.0
// Comparison of fits of one recording that began at different starts.
#pragma once

#include "kinfer/estimate/continuous/solver/cost.hpp"

namespace kinfer {

/// How far two machines differ: the largest angle between the axes [rad], and the largest distance between the axis
/// lines near the sensors [m], over all revolute bodies and both of their frames.
struct JointDifference {
  double angle = 0.0, distance = 0.0;
};
JointDifference largest_difference(const InsBodies& a, const InsBodies& b);

/// −2 log likelihood of a fit's measurements and priors, up to a constant that fits of the same problem share: unlike
/// the cost it compares fits with different noise.
double negative_log_likelihood(const InsProblem& problem, const InsCost& cost);

}  // namespace kinfer
