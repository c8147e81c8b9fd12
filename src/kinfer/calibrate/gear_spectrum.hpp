// Periodic joint errors that nobody has named: lines in the spectrum of the residuals over each joint's angle.
#pragma once

#include <vector>

#include "kinfer/evidence/estimate.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

struct SpectralLine {
  int joint = 0;       ///< index into Chain::joints
  double order = 0.0;  ///< per turn of the joint
  double improvement =
      0.0;  ///< of the sum of squared residuals in units of the noise, by sine and cosine of that order
};

/// The strongest lines that chance does not explain, strongest first, at most `most`. Orders from 3 per turn up to what
/// motors with high gear ratios make are tried, in steps that a joint's range resolves. Point residuals only.
std::vector<SpectralLine> gear_spectrum(const Estimate& fitted, const PoseSet& rows, int most = 12);

}  // namespace kinfer
