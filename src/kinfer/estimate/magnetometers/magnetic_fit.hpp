// SPDX-License-Identifier: Apache-2.0
// Magnetometers as instruments: rotations of sub-trees, the field, and the hard and soft iron of each sensor, by least
// squares with the noise that the residuals show (autoregression). How much iron the sensors carry is estimated too
// (empirical Bayes, MacKay 1992: sd² = Σ x² / Σ (1 − variance / sd²) over all sensors), never less than the sensor
// grade states: sound magnetometers stay sharp, and those on a steel boom become free.
#pragma once

#include <optional>

#include "kinfer/estimate/magnetometers/autoregression.hpp"
#include "kinfer/estimate/magnetometers/magnetic_model.hpp"

namespace kinfer {

struct MagneticFit {
  MagneticUnknowns unknowns;               ///< `rotation`: the most likely one, other instruments included
  MatrixXd information;                    ///< [1/rad²] of the magnetometers about the rotations, all else unknown
  VectorXd mean;                           ///< [rad] where the magnetometers alone would put the rotations
  IronPrior iron;                          ///< as estimated
  std::vector<AutoregressiveNoise> noise;  ///< of each series
};

/// `least`: of each standard deviation of iron. `information` [1/rad²]: of the rotations about 0, from other
/// instruments. Empty if the equations have no solution.
std::optional<MagneticFit> fit_magnetometers(const MagneticRecording& recording,
                                             const std::vector<SubtreeRotation>& rotations, const IronPrior& least,
                                             ConstMatrixRef information);

}  // namespace kinfer
