// What only a full fit shows: readings that were taken while the arm moved, a base that drifts, rows that are wrong.
#pragma once

#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {

/// Commanded against read-back readings: the data keep those that explain the points better.
void check_commanded(DoctorCase& patient);

/// Drift or a step of the base over the rows, and rows that no noise explains.
void check_residuals(DoctorCase& patient);

}  // namespace kinfer
