// SPDX-License-Identifier: Apache-2.0
// Diagnosis of pose sets: errors in the data or in the robot file, found before the calibration.
//
// Data that base, tool and tolerances explain are sound. If only another interpretation of the data explains them, that
// interpretation is reported as a fault; it is certain if it reduces the error to what the tolerances allow.
#pragma once

#include "kinfer/calibrate/diagnosis/orientation_conventions.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/facts/findings.hpp"

namespace kinfer::calibrate {

struct Diagnosis {
  std::vector<Finding> findings;
  CalibrationTask corrected_task;  ///< with all certain faults corrected; row indices are unchanged
};

/// Never fails: checks that need more measurements than there are, are skipped. `alternatives`: other interpretations
/// of the file's orientations.
Diagnosis diagnose(const CalibrationTask& task, const AlternativeOrientations& alternatives = {});

/// Only whether the joint positions are those of the measured tool: the other checks need a single mounting.
Diagnosis diagnose_joint_positions(const CalibrationTask& task);

}  // namespace kinfer::calibrate
