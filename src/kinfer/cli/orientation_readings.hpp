// The orientations of a foreign file as every Euler sequence would have them, for the doctor to choose from.
#pragma once

#include "kinfer/calibrate/doctor_orientations.hpp"
#include "kinfer/io/pose_set_csv.hpp"

namespace kinfer::cli {

/// Reads the file again for each of the 24 sequences, in degrees and in radians; nothing where it has no Euler angles.
std::vector<OrientationReading> orientation_readings(const std::string& file, const Chain& chain, const ColumnMap& map);

}  // namespace kinfer::cli
