// Units, signs, offsets and columns that do not mean what the robot file says: each is tried as a hypothesis, and
// believed where base and tool alone then explain the points.
#pragma once

#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {

/// Lengths of the file or of the robot in the wrong unit, and angles likewise.
void check_conventions(DoctorCase& patient);

}  // namespace kinfer
