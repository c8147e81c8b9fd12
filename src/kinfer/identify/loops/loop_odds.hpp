// SPDX-License-Identifier: Apache-2.0
// Whether two bodies of the tree share a joint as well: the odds of a closed loop against joints that move as they
// like.
//
// In a fit that leaves the loop open, the gap between the two halves of a closing joint is a prediction that nothing
// forces to be small. If the loop is closed, it is play and the error of the estimated motion (standard deviation s per
// component). If it is open, the best joint leaves about as much as it does where the same joints make the same
// movements but for one, which is mirrored about its mean (r per component, the least of all such): no mirrored linkage
// closes. This holds for joints that move in step, too, the hardest open chain to tell from a closed one, because any
// two of its bodies rotate about one point to first order. With n different positions of the machine and g the rms gap,
// Gaussian in both cases,
//   ln odds = n' ln (r / s) − n g² / 2 (1 / s² − 1 / r²) + ln prior odds,   n' = 2 n − 4,
// as the gap has two components across the axis and the best points of a joint take four; likewise for its direction.
// How much play a machine has is not known: the likelihood ratio is averaged over two decades of s.
#pragma once

#include "kinfer/identify/loops/closing_joint.hpp"

namespace kinfer::identify {

struct LoopEvidence {
  ClosingJoint closing{};   ///< of the motion as estimated
  ClosingJoint mirrored{};  ///< of the same motion with one joint mirrored, the one that closes best
  double positions = 0.0;   ///< n
  double lever = 0.0;       ///< [m] length of the open chain between the two bodies
};

/// ln of the posterior odds.
double log_odds(const LoopEvidence& evidence);

}  // namespace kinfer::identify
