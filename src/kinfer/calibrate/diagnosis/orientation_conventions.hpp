// SPDX-License-Identifier: Apache-2.0
// Orientations written in another convention than assumed by the reader.
#pragma once

#include <functional>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {

/// Another interpretation of the orientations of a file, with one entry per orientation of the data.
struct OrientationInterpretation {
  FactValues convention;  ///< "euler" ("ZYX extrinsic") and "unit" ("deg"); or "quaternions": inverse, scalar_last,
                          ///< mirrored_x, mirrored_y, mirrored_z
  std::vector<OrientationMeasurement> orientations;
};

/// Generates them on demand, since that may require reading the file again.
using AlternativeOrientations = std::function<std::vector<OrientationInterpretation>()>;

/// Compares the orientations with the flange rotations of the chain fitted to the points. Besides `others`, quaternions
/// are tried inverted, in the order x, y, z, w, and mirrored.
void check_orientations(DiagnosisState& state, const AlternativeOrientations& others);

}  // namespace kinfer::calibrate
