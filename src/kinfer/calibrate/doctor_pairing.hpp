// Joint readings and measurements that were not taken together: shifted, exchanged, or with the base moved in between.
#pragma once

#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {

/// Whether a model was found by which the pairing could be judged: a fit to all rows, or to a run of them.
enum class PairingJudged { yes, no };

/// Rows that are put right keep their number: their readings are replaced by those that belong to the measurement, and
/// a measurement without readings is dropped.
PairingJudged check_pairing(DoctorCase& patient);

}  // namespace kinfer
