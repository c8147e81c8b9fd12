// Hinges that are none in the strict sense: a bearing with play, a twisting segment, a mount that gives way. Their axis
// strays by degrees, and gravity seen askew then shortens the lengths of the neighbours.
//
// In the fit such a joint turns freely (a ball); its hinge is the pair of directions, a in the parent and b in the
// child, that stay nearest to each other: max Σ a · R b, the largest singular pair of the mean of R.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"
#include "kinfer/identify/joint_start.hpp"

namespace kinfer {

struct LooseHinge {
  InsBody body;         ///< a hinge with the points of the ball
  double zero = 0.0;    ///< [rad] its reading where the recording begins
  double stray = 0.0;   ///< [rad] rms angle between a and R b
  MatrixXd covariance;  ///< of the hinge's ten unknowns, the axis' part from the stray
};

/// `rotations`: parent_R_child at evenly spaced times, the first where the recording begins. `points`: 6 x 6 covariance
/// of the ball's centre in the parent and in the child. `crossed` [rad]: what the sensors' own axes are askew.
LooseHinge loose_hinge(const InsBody& ball, std::span<const Mat3> rotations, ConstMatrixRef points, double crossed);

/// Readings of the hinge less its zero at these orientations, one row [rad]; one after the other, without jumps.
MatrixXd loose_film(const LooseHinge& hinge, std::span<const Mat3> rotations);

/// The same motion of the same body as a ball in place of the hinge.
void loosen(InsUnknowns& x, const InsLayout& layout, std::size_t body);

}  // namespace kinfer
