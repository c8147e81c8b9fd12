// SPDX-License-Identifier: Apache-2.0
// Calibrates a robot from a nominal model and a pose set, in your own program.
#include <fmt/core.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/io/robot/robot_errors_toml.hpp"
#include "kinfer/simulate/pose_set.hpp"

int main() {
  using namespace kinfer;
  using namespace kinfer::calibrate;
  const RobotModel robot = read_robot_toml("robot6/robot.toml").value();
  const Chain truth = read_robot_errors("robot6/errors.toml", robot).value();
  const PoseSimulation tracker{.poses = 50, .instrument = *robot.instrument};
  const PoseSet measured = simulate_pose_set(truth, tracker, Rng(1)).value();

  const CalibrationTask task{robot.chain, robot.tolerances, robot.instrument, measured};
  const auto calibration = calibrate_robot(task, {}, Rng(1));
  if (!calibration) {
    fmt::print("{}\n", calibration.error().what);
    return 1;
  }
  fmt::print("{}\n", calibration->verdict);
  for (const std::string& words : calibration->estimate.identifiability.confounded) fmt::print("- {}\n", words);
  return calibration->usable ? 0 : 1;
}
