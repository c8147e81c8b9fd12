// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/verdict.hpp"

#include "kinfer/calibrate/conclusion/thresholds.hpp"

namespace kinfer::calibrate {
namespace {

CalibrationReason judge_against_nominal(const Calibration& calibration) {
  const ErrorStatistics &before = reported_errors(calibration, calibration.before),
                        &after = reported_errors(calibration, calibration.after);
  if (!(after.mean < before.mean)) return CalibrationReason::no_improvement;
  if (!(final_errors(calibration).rms <= thresholds::same_solution_ratio * after.rms))
    return CalibrationReason::not_validated;
  const std::optional<double>& expected = calibration.expected_holdout_rms;
  if (expected && !(after.rms <= thresholds::expectation_ratio * *expected))
    return CalibrationReason::unmodelled_effects;
  return CalibrationReason::improves_nominal;
}

CalibrationReason judge_generalisation(const TrainHoldout& errors) {
  const bool generalises =
      errors.holdout.n > 0 && errors.holdout.mean <= thresholds::generalisation_ratio * errors.train.mean;
  return generalises ? CalibrationReason::generalises : CalibrationReason::overfitted;
}

}  // namespace

CalibrationReason judge(const Calibration& calibration) {
  return calibration.unknown_robot ? judge_generalisation(calibration.after.position)
                                   : judge_against_nominal(calibration);
}

Usability usability_of(CalibrationReason reason) {
  return reason == CalibrationReason::improves_nominal || reason == CalibrationReason::generalises
             ? Usability::use
             : Usability::do_not_use;
}

}  // namespace kinfer::calibrate
