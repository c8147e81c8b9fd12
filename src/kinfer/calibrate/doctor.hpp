// The doctor for pose sets: what is wrong with the data, or with the robot file, before any fit is believed.
//
// Each check tries to explain what it sees. What base, tool and tolerances explain is healthy; what only one other
// reading of the data explains is a fault, and it is certain where the error falls to what the tolerances excuse.
#pragma once

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/doctor_orientations.hpp"
#include "kinfer/evidence/findings.hpp"

namespace kinfer {

struct Diagnosis {
  std::vector<Finding> findings;
  CalibrateTask treated;  ///< with all that was certain put right; rows keep their numbers
};

/// Never fails: where too little is measured to judge, the checks that need more are left out. `readings`: other ways
/// in which the file's orientations may be meant.
Diagnosis examine(const CalibrateTask& task, const OtherReadings& readings = {});

/// What was found and what was done, as a sentence for a note: "…; put right: …".
std::string in_words(const Finding& finding);

}  // namespace kinfer
