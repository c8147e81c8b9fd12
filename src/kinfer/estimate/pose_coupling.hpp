// The six rows of a measured pose whose point and orientation err together, whitened together.
//
// Let u be the point's error and v the orientation's, each along the axes of its own covariance in units of its own
// deviations, so that the covariance of (u, v) is [I Y; Yᵀ I]. Then v − Yᵀu is independent of u and has the covariance
// I − YᵀY = L Lᵀ: u and L⁻¹(v − Yᵀu) are six independent rows of unit variance (Cholesky's factorisation by blocks).
// The point's rows stay what they are, so a pose whose orientation is wrong or not kept loses nothing else.
#pragma once

#include <vector>

#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct PoseCoupling {
  int orientation = 0, point = 0;  ///< into the pose set's lists
  Mat3 own = Mat3::Identity();     ///< L⁻¹
  Mat3 from_point = Mat3::Zero();  ///< −L⁻¹Yᵀ

  /// Rows of the orientation (3 x n), made independent of those of the point; both in units of their deviations.
  template <class Rows, class PointRows>
  void whiten(Rows&& turn, const PointRows& beside) const {
    turn = (own * turn + from_point * beside).eval();
  }

  /// log det(I − YᵀY): what the coupling takes from the pose's entropy, twice.
  double log_determinant() const;
};

/// Of the orientations with a covariance with the point of their row, where that point is in the set. `point_sd`,
/// `orientation_sd`: one a measurement, along its axes. Variances that grow weaken a coupling.
std::vector<PoseCoupling> couplings_of(const PoseSet& data, const std::vector<Vec3>& point_sd,
                                       const std::vector<Vec3>& orientation_sd);

/// An error given another that it goes with: what is left of it, and the covariance of that.
struct RemainingError {
  Vec3 error = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};
/// `together`: covariance of the error (rows) with the known one (columns).
RemainingError given(const RemainingError& known, const RemainingError& error, const Mat3& together);

}  // namespace kinfer
