// SPDX-License-Identifier: Apache-2.0
// The angles of a chain from orientations alone: Σ |R − R~|² is a sinusoid in each angle, so coordinate ascent over
// three moments of the recording, then Newton's method, maximise the agreement.
#pragma once

#include <array>
#include <vector>

#include "kinfer/identify/programming/dh_leaf.hpp"

namespace kinfer::identify {

/// Σ R, Σ cos q R, Σ sin q R with R parent_R_child and q the joint signal.
using RotationMoments = std::array<Mat3, 3>;

/// Maximises Σ tr(R~ᵀ R) over the angles from their current values, and returns it: half the sum of the squared chords
/// is 3 n minus this. `angles`: of the leaves; the signal occurs once in them. `tolerance`: gain at which Newton's
/// method ends.
double maximise_agreement(std::vector<DhLeaf>& leaves, const std::vector<double*>& angles,
                          const RotationMoments& moments, double tolerance);

}  // namespace kinfer::identify
