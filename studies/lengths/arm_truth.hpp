// SPDX-License-Identifier: Apache-2.0
// Truth of a KUKA LBR iiwa 7 with an INS on each of its links 1 to 6: joint axes in the sensors' frames by its encoders
// and the sensors' gyroscopes, and the two lengths that the axes enclose.
#pragma once

#include <filesystem>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer::study::lengths_study {

/// sensor_R_link of the links 1 to 6, in the order of `sensors` (names of links 1 to 6): the rotation that maps the
/// encoders' angular velocities to the gyroscope's best (Wahba 1965). Link 1 turns about one axis only, which leaves
/// its rotation about that axis open.
Result<std::vector<Mat3>> link_rotations(const InsRecording& recording, const std::filesystem::path& encoders,
                                         const std::vector<std::string>& sensors);

struct AxisError {
  int joint = 0;  ///< from 1
  std::string sensor;
  double angle = 0.0, sd = 0.0;  ///< [rad] of the found axis to the true one, and its stated sd in both directions
};

/// Of the joints 2 to 6 in the frames of the links 2 to 6.
std::vector<AxisError> axis_errors(const Identification& found, const std::vector<std::string>& sensors,
                                   const std::vector<Mat3>& sensor_R_link);

struct AxialLength {
  double length = 0.0, sd = 0.0;  ///< [m]
};

/// Along the axis of joint `middle`, between the axes of the joints before and behind it; empty if one is missing.
std::optional<AxialLength> axial_length(const Identification& found, const std::vector<std::string>& sensors,
                                        int middle);

}  // namespace kinfer::study::lengths_study
