// SPDX-License-Identifier: Apache-2.0
// Imperfect revolute joints: a bearing with play, a flexible segment, a compliant mount. Their axis wanders by degrees;
// a revolute model then misaligns gravity and biases the neighbouring lengths.
//
// The fit relaxes such a joint to a spherical one. Its mean revolute axis is the pair of directions, a in the parent
// and b in the child, that stay closest to each other: max Σ a · R b, the largest singular pair of the mean of R.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer::identify {

struct MeanRevolute {
  InsBody body;                   ///< revolute, with the points of the spherical joint
  double zero = 0.0;              ///< [rad] its joint position at the begin of the recording
  double axis_deviation = 0.0;    ///< [rad] rms angle between a and R b
  MatrixXd covariance;            ///< of the ten unknowns; the axis' part from its wander
  double deviation_memory = 0.0;  ///< [rotations] over which the angle between the axes stays alike: a first-order
                                  ///< Gauss-Markov process' correlation time
};

/// `rotations`: parent_R_child at evenly spaced times, the first at the begin of the recording. `points`: 6 x 6
/// covariance of the spherical joint's centre in the parent and in the child. `misalignment` [rad]: of the sensors'
/// own axes.
MeanRevolute fit_mean_revolute(const InsBody& spherical, std::span<const Mat3> rotations, ConstMatrixRef points,
                               double misalignment);

/// Joint positions at these orientations, relative to `zero`, unwrapped; one row [rad].
MatrixXd revolute_trajectory(const MeanRevolute& revolute, std::span<const Mat3> rotations);

/// Replaces a body's revolute joint by a spherical one with the same motion.
void relax_to_spherical(InsUnknowns& x, const InsLayout& layout, std::size_t body);

}  // namespace kinfer::identify
