// SPDX-License-Identifier: Apache-2.0
// How far estimated joints are from the true ones (docs/development/methods/continuous-time-fit.md), scalar by scalar
// beside their stated standard deviations.
#pragma once

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/simulate/ground_truth.hpp"

namespace kinfer::study {

struct ScoredScalar {
  std::string name;
  double error = 0.0, sd = 0.0;  ///< [m] or [rad]
};

struct GeometryScore {
  double line = 0.0;          ///< [m] worst distance of an axis line, without unobservable directions
  double direction = 0.0;     ///< [rad] worst
  double azimuth = 0.0;       ///< [rad] worst rotation of a body about its only axis, removed before
  double axial_offset = 0.0;  ///< [m] worst, where observable
  bool complete = true;       ///< every true joint was identified
  std::vector<ScoredScalar> scalars;
};
GeometryScore geometry_score(const std::vector<JointEstimate>& estimates, const MachineTruth& truth);

}  // namespace kinfer::study
