// SPDX-License-Identifier: Apache-2.0
// Calibrates a robot from a nominal model and a pose set, in your own program.
#include <fmt/core.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/io/robot/toml/robot_errors_toml.hpp"
#include "kinfer/simulate/pose_set.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/findings/outliers.hpp"

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
  fmt::print("{}\n", words::verdict(*calibration));
  for (const std::string& text : words::undetermined_sentences(calibration->estimate.identifiability))
    fmt::print("- {}\n", text);
  return calibration->usability == Usability::use ? 0 : 1;
}
