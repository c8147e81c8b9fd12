// SPDX-License-Identifier: Apache-2.0
// Periodic joint errors of unknown order: spectral lines of the residuals over each joint's angle.
#pragma once

#include <vector>

#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

struct SpectralLine {
  int joint = 0;       ///< index into Chain::joints
  double order = 0.0;  ///< periods per revolution of the joint
  double improvement =
      0.0;  ///< reduction of the sum of squared normalised residuals by a sine and a cosine of that order
  double resolution = 0.0;  ///< [1/rev] one period over the joint's range
};

/// The statistically significant lines, strongest first, at most `most`. Orders from 3 per revolution up to those of
/// motors with high gear ratios are tested, in steps that the joint's range can resolve. Point residuals only.
std::vector<SpectralLine> find_gear_harmonics(const Estimate& fitted, const PoseSet& rows, int threads = 1,
                                              int most = thresholds::max_spectral_lines);

/// Appends the lines of `more` that the joint's range of positions can tell from those of `lines`, up to
/// max_spectral_lines.
void merge_lines(std::vector<SpectralLine>& lines, const std::vector<SpectralLine>& more);

}  // namespace kinfer::calibrate
