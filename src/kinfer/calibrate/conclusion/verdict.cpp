// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/verdict.hpp"

#include <algorithm>

#include "kinfer/calibrate/conclusion/thresholds.hpp"

namespace kinfer::calibrate {
namespace {

/// The errors that were measured, or those that the predictions' intervals have room for.
bool exceeds_expectation(const Calibration& calibration, double measured) {
  const std::optional<double>& expected = calibration.expected_holdout_rms;
  if (!expected) return false;
  const double limit = thresholds::expectation_ratio * *expected;
  return !(measured <= limit) || !(calibration.predicted_holdout_rms.value_or(*expected) <= limit);
}

bool is_proven(const Calibration& calibration) {
  return calibration.chance_of_improvement.value_or(0.0) <= thresholds::unproven_chance;
}

bool has_note(const Calibration& calibration, CalibrationNoteKind kind) {
  return std::ranges::any_of(calibration.notes, [&](const CalibrationNote& note) { return note.kind == kind; });
}

/// A refit of offsets that does not improve the earlier model beyond chance, which explains the poses as it is. How
/// much worse the refit is says nothing: with more free numbers it must be a little worse on held-out poses.
bool nothing_has_moved(const Calibration& calibration) {
  const bool none_moved = has_note(calibration, CalibrationNoteKind::no_offset_moved);
  if (!none_moved && !has_note(calibration, CalibrationNoteKind::joint_offset_moved)) return false;
  const ErrorStatistics &before = reported_errors(calibration, calibration.before),
                        &after = reported_errors(calibration, calibration.after);
  if (after.mean < before.mean && is_proven(calibration)) return false;
  return calibration.expected_holdout_rms
             ? before.rms <= thresholds::expectation_ratio * *calibration.expected_holdout_rms
             : none_moved;
}

CalibrationReason judge_against_nominal(const Calibration& calibration) {
  const ErrorStatistics &before = reported_errors(calibration, calibration.before),
                        &after = reported_errors(calibration, calibration.after);
  const bool unchanged = nothing_has_moved(calibration);
  if (!unchanged && !(after.mean < before.mean)) return CalibrationReason::no_improvement;
  if (!(final_errors(calibration).rms <= thresholds::same_solution_ratio * after.rms))
    return CalibrationReason::not_validated;
  if (exceeds_expectation(calibration, after.rms)) return CalibrationReason::unmodelled_effects;
  if (after.rms > calibration.tolerated_error)
    return calibration.noise_is_stated ? CalibrationReason::beyond_tolerances : CalibrationReason::unexplained;
  if (!unchanged && !is_proven(calibration)) return CalibrationReason::unproven;
  if (calibration.noise_holdout_rms && !(after.rms <= thresholds::expectation_ratio * *calibration.noise_holdout_rms))
    return CalibrationReason::beyond_noise;
  if (calibration.tolerance_factor >= thresholds::strange_tolerance_factor) return CalibrationReason::far_from_nominal;
  return unchanged ? CalibrationReason::unchanged : CalibrationReason::improves_nominal;
}

CalibrationReason judge_generalisation(const TrainHoldout& errors) {
  const bool generalises =
      errors.holdout.n > 0 && errors.holdout.mean <= thresholds::generalisation_ratio * errors.train.mean;
  return generalises ? CalibrationReason::generalises : CalibrationReason::overfitted;
}

}  // namespace

CalibrationReason judge(const Calibration& calibration) {
  if (calibration.least_motion <= thresholds::no_motion) return CalibrationReason::collapsed;
  if (calibration.contradiction) return CalibrationReason::contradictory;
  if (std::ranges::any_of(calibration.findings, invalidates_result)) return CalibrationReason::fault_remains;
  return calibration.unknown_robot ? judge_generalisation(calibration.after.position)
                                   : judge_against_nominal(calibration);
}

Usability usability_of(CalibrationReason reason, const std::optional<UnobservedLengths>& unobserved) {
  switch (reason) {
    case CalibrationReason::unproven:
    case CalibrationReason::far_from_nominal:
    case CalibrationReason::beyond_noise:
    case CalibrationReason::unexplained:
      return Usability::use_with_care;
    case CalibrationReason::improves_nominal:
    case CalibrationReason::generalises:
    case CalibrationReason::unchanged:
      return unobserved ? Usability::use_with_care : Usability::use;
    case CalibrationReason::no_improvement:
    case CalibrationReason::not_validated:
    case CalibrationReason::unmodelled_effects:
    case CalibrationReason::overfitted:
    case CalibrationReason::beyond_tolerances:
    case CalibrationReason::contradictory:
    case CalibrationReason::collapsed:
    case CalibrationReason::fault_remains:
      break;
  }
  return Usability::do_not_use;
}

}  // namespace kinfer::calibrate
