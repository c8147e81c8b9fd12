// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/starting_model.hpp"

#include <algorithm>

#include "kinfer/calibrate/start/unknown_robot.hpp"
#include "kinfer/calibrate/validation/validation_plan.hpp"
#include "kinfer/kinematics/same_joints.hpp"

namespace kinfer::calibrate {
namespace {

/// Numbers of a joint that are in lists are compared by their place: the earlier chain must have those of the nominal.
bool has_terms_of(const Joint& earlier, const Joint& nominal) {
  const auto same_coupling = [](const Coupling& a, const Coupling& b) { return a.joint == b.joint; };
  const auto same_harmonic = [](const Harmonic& a, const Harmonic& b) { return a.order == b.order; };
  return earlier.couplings.size() >= nominal.couplings.size() && earlier.harmonics.size() >= nominal.harmonics.size() &&
         std::equal(nominal.couplings.begin(), nominal.couplings.end(), earlier.couplings.begin(), same_coupling) &&
         std::equal(nominal.harmonics.begin(), nominal.harmonics.end(), earlier.harmonics.begin(), same_harmonic);
}

}  // namespace

Result<void> check_same_joints(const Chain& earlier, const Chain& nominal) {
  if (!have_same_joints(earlier, nominal))
    return error("expected an earlier calibration of this kind of robot ({} joints of the same types)",
                 nominal.joints.size());
  for (std::size_t j = 0; j < nominal.joints.size(); ++j)
    if (!has_terms_of(earlier.joints[j], nominal.joints[j]))
      return error("expected an earlier calibration of this kind of robot: joint {} has other couplings or harmonics",
                   nominal.joints[j].name);
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
