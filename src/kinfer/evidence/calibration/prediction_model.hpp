// SPDX-License-Identifier: Apache-2.0
// What the uncertainty of a calibrated chain at any joint positions is computed from; kept in chain.toml.
//
// covariance of the tool = J(q) Σ J(q)ᵀ + M + share(q) G: uncertainty of the parameters, the model error M that
// held-out rows show beyond it and beyond the instrument's noise, and what parts of the joint space that were not
// fitted show beyond that. share(q) rises from 0 among the fitted rows to 1 where all of the nearest lie to one side.
//
// What corrections of gears found out among the fitted rows says nothing of joint positions far from them:
// there the parameters are those of a fit without these terms, x + (1 − weight(q)) · beyond, with
// weight(q) = 1 / (1 + fade · (distance(q) / reach − 1)²) beyond the reach; distance to the nearest of `rows` in units
// of `spread`.
#pragma once

#include <string>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct PredictionModel {
  std::vector<std::string> parameters{};  ///< names of the free parameters
  MatrixXd root{};                        ///< L, lower triangular, with the covariance Σ = L Lᵀ of these, SI
  /// M, 6 x 6: position [m] and rotation [rad] of the tool, along the axes of the base. Zero where it was not measured.
  MatrixXd model_error = MatrixXd::Zero(6, 6);
  MatrixXd outside_error = MatrixXd::Zero(6, 6);  ///< G, as M
  MatrixXd rows{};     ///< dof x m: joint positions that stand for the fitted rows, [rad] or [m]
  VectorXd spread{};   ///< dof: standard deviation of each joint over the fitted rows, [rad] or [m]
  double reach = 1.0;  ///< [1] distance up to which joint positions count as measured
  double edge = 1.0;   ///< [1] one-sidedness of the nearest rows at which share(q) is a half
  /// [m] of the instrument, per axis, where its residuals had to tell: with it, 95 % of the held-out points lie within
  /// their 95 % ellipsoids. 0: it was stated.
  double noise = 0.0;
  /// What the parameters change by far from the fitted rows, SI. Empty: nothing, the corrections hold everywhere.
  VectorXd beyond{};
};

/// Distance to the nearest of `rows` in units of `spread`, over `reach`: above 1 outside the measured region.
double region_distance(const PredictionModel& model, ConstVectorRef q);

/// weight(q) of the corrections: 1 where it was measured, and everywhere if none of them fades.
double correction_weight(const PredictionModel& model, ConstVectorRef q);

/// weight(q) of corrections that fade.
double fading_weight(const PredictionModel& model, ConstVectorRef q);

/// How far the nearest of `rows` lie to one side of q: distance of q from their mean over their rms spread about it, in
/// units of `spread`; rows at q itself do not count. Zero with fewer than four rows. Outside the convex hull of the
/// rows it is large however dense they are, in gaps between them small.
double one_sidedness(const PredictionModel& model, ConstVectorRef q);

/// share(q) = a⁴ / (1 + a⁴), a = one_sidedness(q) / edge.
double outside_share(const PredictionModel& model, ConstVectorRef q);

/// M + share(q) G, 6 x 6, along the axes of the base.
MatrixXd model_error_at(const PredictionModel& model, ConstVectorRef q);

}  // namespace kinfer
