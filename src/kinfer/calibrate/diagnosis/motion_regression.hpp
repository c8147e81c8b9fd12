// SPDX-License-Identifier: Apache-2.0
// Regression of a fit's point residuals on joint motions: was the arm where its joint positions say?
//
// A point measured while the joints were at q + λ Δq has the residual J(q) λ Δq. What the parameters of the fit and
// further columns could have absorbed is projected out of the motion first (Frisch, Waugh 1933; Lovell 1963); the
// variance is that of residuals of unequal size, correlated within a row (White 1980).
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// Joint displacements of every row, dof x rows, [rad] or [m]; NaN: the row is not used.
using JointMotions = MatrixXd;

struct MotionShare {
  double fraction = 0.0, sd = 0.0;  ///< λ, of the motion
  double distance = 0.0;            ///< [m] rms displacement of the points by λ Δq, as far as no parameter absorbs it
  double explained = 0.0;           ///< [1] share of the residuals' sum of squares
  std::vector<double> others{};     ///< coefficients of `others`
  double t() const { return fraction / sd; }
};

/// λ of `motion` beside the motions `others` (fitted too). `fit`: of these rows, at their joint positions. Nothing
/// where there are fewer than two equations an unknown, or the motion cannot be told from the rest.
std::optional<MotionShare> regress_on_motion(const Estimate& fit, const PoseSet& data, const JointMotions& motion,
                                             const std::vector<JointMotions>& others = {});

}  // namespace kinfer::calibrate
