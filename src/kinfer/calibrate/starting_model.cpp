// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/starting_model.hpp"

#include "kinfer/calibrate/start/unknown_robot.hpp"
#include "kinfer/calibrate/validation/validation_plan.hpp"
#include "kinfer/kinematics/same_joints.hpp"

namespace kinfer::calibrate {

Result<void> check_same_joints(const Chain& earlier, const Chain& nominal) {
  if (!have_same_joints(earlier, nominal))
    return error("expected an earlier calibration of this kind of robot ({} joints of the same types)",
                 nominal.joints.size());
  return {};
}

Result<StartingModel> make_starting_model(const CalibrationTask& given, const CalibrationOptions& options, Rng rng) {
  StartingModel start{given};
  CalibrationTask& task = start.task;
  if (!task.joint_types.empty()) {
    KINFER_TRY(plan, make_validation_plan(task.data, options, rng.stream(1)));
    KINFER_TRY(found, estimate_unknown_robot(task.joint_types, select(task.data, plan.fitted), options.threads,
                                             rng.stream(17)));
    task.nominal = found.nominal;
    task.tolerances = found.tolerances;
    start.unknown_robot = found.evidence;
  }
  for (const Chain& earlier : task.robot_population)
    if (auto same = check_same_joints(earlier, task.nominal); !same) return forward_error(same.error());
  if (!task.earlier) return start;
  if (auto same = check_same_joints(*task.earlier, task.nominal); !same) return forward_error(same.error());
  if (std::holds_alternative<JointOffsetParameters>(options.parameters)) {
    task.nominal = *task.earlier;
    task.earlier.reset();
  }
  return start;
}

}  // namespace kinfer::calibrate
