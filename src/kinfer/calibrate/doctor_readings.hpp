// Checks that need no fit: joints that hardly move, rows that were copied, targets that are not rigid on the tool.
#pragma once

#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {

void check_readings(DoctorCase& patient);
void check_copied_rows(DoctorCase& patient);
void check_rigidity(DoctorCase& patient);

}  // namespace kinfer
