// SPDX-License-Identifier: Apache-2.0
// Joint whitening of the six rows of a measured pose whose point and orientation errors are correlated.
//
// Let u be the point's error and v the orientation's, each along the axes of its own covariance in units of its own
// standard deviations, so that the covariance of (u, v) is [I Y; Yᵀ I]. Then v − Yᵀu is independent of u and has the
// covariance I − YᵀY = L Lᵀ: u and L⁻¹(v − Yᵀu) are six independent rows of unit variance (block Cholesky
// factorisation). The point's rows are not changed, so a pose whose orientation is an outlier keeps its point.
#pragma once

#include <vector>

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct PoseCoupling {
  int orientation = 0, point = 0;  ///< indices into the pose set's lists
  Mat3 own = Mat3::Identity();     ///< L⁻¹
  Mat3 from_point = Mat3::Zero();  ///< −L⁻¹Yᵀ

  /// Makes the rows of the orientation (3 x n) independent of those of the point; both in units of their standard
  /// deviations.
  template <class Rows, class PointRows>
  void whiten(Rows&& turn, const PointRows& beside) const {
    turn = (own * turn + from_point * beside).eval();
  }

  /// log det(I − YᵀY): twice the reduction of the pose's entropy by the correlation.
  double log_determinant() const;
};

/// Of the orientations that are correlated with the point of their row, if that point is in the set. `point_sd`,
/// `orientation_sd`: one per measurement, along its axes. Larger variances weaken a coupling.
std::vector<PoseCoupling> couplings_of(const PoseSet& data, const std::vector<Vec3>& point_sd,
                                       const std::vector<Vec3>& orientation_sd);

/// Conditional error and its covariance, given another, correlated error.
struct ConditionalError {
  Vec3 error = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};
/// `together`: cross-covariance of the error (rows) with the known one (columns).
ConditionalError condition_on(const ConditionalError& known, const ConditionalError& error,
                              const Mat3& cross_covariance);

}  // namespace kinfer
