// SPDX-License-Identifier: Apache-2.0
// Orientations of a foreign file under every Euler convention, as hypotheses for the diagnosis.
#pragma once

#include "kinfer/calibrate/diagnosis/orientation_conventions.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"

namespace kinfer::cli {

/// Reads the file again for each of the 24 sequences, in degrees and in radians; empty if it has no Euler angles.
std::vector<calibrate::OrientationInterpretation> orientation_hypotheses(const std::string& file, const Chain& chain,
                                                                         const ColumnMap& map);

}  // namespace kinfer::cli
