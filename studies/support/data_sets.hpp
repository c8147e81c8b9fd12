// SPDX-License-Identifier: Apache-2.0
// Measured and simulated robots for studies of calibration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/calibrate/problem/task.hpp"

namespace kinfer::study {

struct NamedTask {
  std::string name;
  calibrate::CalibrationTask task;
  std::string truth{};  ///< the terms that made the data, as `--model` takes them; empty: not known, or not among them
};

/// The public sets under KINFER_DATA and the simulated cases under KINFER_CASES whose name contains `wanted`, then
/// `simulated` robots: rigid ones, and ones with terms known and unknown to the model.
std::vector<NamedTask> named_tasks(const std::string& wanted, int simulated);

/// The paper's robot with errors of geometry alone, 40 poses by a tracker, and 200 poses that were not measured.
struct RigidRobot {
  calibrate::CalibrationTask task;
  PoseSet unseen;  ///< points without noise
};
RigidRobot rigid_robot(int seed);

}  // namespace kinfer::study
