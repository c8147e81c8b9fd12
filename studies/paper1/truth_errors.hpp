// SPDX-License-Identifier: Apache-2.0
// Geometry errors of an identified chain against the simulation's truth, without unobservable directions.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study::paper1_study {

struct GeometryErrors {
  double line = 0.0;       ///< [m] worst distance of axis lines, over joints and both frames
  double direction = 0.0;  ///< [rad] worst angle between axes
  double azimuth = 0.0;    ///< [rad] rotation about a body's only axis that was removed first
};

/// A body with one fixed axis only is first rotated about it to the best fit of its outgoing axis.
GeometryErrors geometry_errors(const std::vector<JointEstimate>& estimates, const MachineTruth& truth);

}  // namespace kinfer::study::paper1_study
