// Orientations that were written in another convention than they were read.
#pragma once

#include <functional>

#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {

/// Another way to read the orientations of a file, one entry for each of those in the data.
struct OrientationReading {
  std::string words;       ///< "extrinsic ZYX angles in degrees"
  std::string suggestion;  ///< what to write, and where
  std::vector<OrientationMeasurement> orientations;
};

/// Makes them where they are needed: that may cost reading the file again.
using OtherReadings = std::function<std::vector<OrientationReading>()>;

/// Judges by the flange's rotations of the chain that explains the points best. Besides `others`, quaternions are tried
/// inverted and in the order x, y, z, w.
void check_orientations(DoctorCase& patient, const OtherReadings& others);

}  // namespace kinfer
