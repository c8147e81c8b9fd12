// SPDX-License-Identifier: Apache-2.0
// What a calibration reports beside its numbers: notes, recommendations and the reason of the verdict, as facts.
#pragma once

#include <string_view>
#include <variant>

#include "kinfer/evidence/facts/fact.hpp"
#include "kinfer/measurement/measurements.hpp"

namespace kinfer {

/// How rows were held out.
struct HoldoutLabels {};  ///< rows labelled `holdout`
struct HoldoutFraction {
  double fraction = 0.2;  ///< of the rows, drawn at random
};
struct HoldoutFolds {
  int folds = 5;  ///< of a cross-validation
};
using HoldoutScheme = std::variant<HoldoutFolds, HoldoutFraction, HoldoutLabels>;

/// Why the calibration may or may not be used.
enum class CalibrationReason {
  improves_nominal,    ///< better than the nominal model on held-out rows, and as good as expected
  no_improvement,      ///< no better than the nominal model on held-out rows
  not_validated,       ///< the final fit converged to another solution than the fits that validate it
  unmodelled_effects,  ///< the errors far exceed what instrument and fit uncertainty explain
  generalises,         ///< without a data sheet: the held-out errors are those of the fitted rows
  overfitted,          ///< without a data sheet: the held-out errors far exceed those of the fitted rows
  unproven,            ///< better than the nominal model on held-out rows, but perhaps by chance
  beyond_tolerances,   ///< better, but worse than the tolerances of the nominal model could make
  far_from_nominal,    ///< better, but by numbers that no tolerance allows: another robot, or other units
  beyond_noise,        ///< better, but worse than the instrument's noise explains; few rows cannot tell why
  contradictory,       ///< kinds of measurements that were fitted together disagree by far more than their noise
  collapsed,           ///< explained only by a robot that does not move where the nominal one does
  fault_remains,       ///< a fault of the data was found that kinfer cannot correct
  unexplained,         ///< better, but worse than the tolerances could make, by an instrument that nothing is known of
  unchanged,           ///< a refit of offsets finds none that has moved: the earlier model still holds
};
std::string_view name(CalibrationReason reason);

/// What no measurement of a calibration determines.
enum class UnobservedLength {
  size,         ///< lengths were measured only in relation to each other: the size rests on the tolerances
  all_lengths,  ///< nothing that was measured depends on a length
};
std::string_view name(UnobservedLength kind);

struct UnobservedLengths {
  UnobservedLength kind{};
  double relative_sd = 0.0;  ///< [1] of the size of the calibrated robot over the measured poses
};

/// A kind of measurement that the rest of the data contradict.
struct Contradiction {
  MeasurementKind kind = kind_of<PointMeasurement>;
  int contradicted = 0, measured = 0;  ///< measurements that neither noise nor tolerances explain, of how many
  double error = 0.0;                  ///< rms over all of them: [m], or [rad] of orientations, tilts and directions
  double noise = 0.0;                  ///< in the same unit; 0: not stated
};

enum class CalibrationNoteKind {
  many_gross_errors,      ///< too many held-out rows with gross errors to exclude them: "rows"
  tolerances_scaled,      ///< the tolerances were too small: "factor"
  frames_from_data,       ///< base and tool of the robot file disagree with the data: "distance_m"
  urdf_geometry_only,     ///< a URDF cannot hold the whole model
  population_used,        ///< the robot may be one of the prior's population: "robots", "log_odds"
  foreign_to_population,  ///< it is not, and was calibrated without that prior: "robots", "log_odds"
  joint_offset_moved,     ///< since the earlier calibration: "parameter", "change_m" or "change_rad", "sigmas"
  no_offset_moved,
};
std::string_view name(CalibrationNoteKind kind);

struct CalibrationNote {
  CalibrationNoteKind kind{};
  FactValues values{};
};

enum class CalibrationAdviceKind {
  use_corrections,
  correct_data,              ///< faults that stand: "faults", how many
  check_model,               ///< residuals far above the noise: "residual_ratio"
  check_outliers,            ///< "rows"
  extend_joint_range,        ///< "joint", "range_m" or "range_rad"
  measure_uncertain_region,  ///< "joints", "positions" [rad] or [m], "prismatic" 0 or 1, "error_there_m", "error_m"
  measure_more_poses,        ///< "more", "poses", "error_m", "enough"
  keep_verification_poses,
};
std::string_view name(CalibrationAdviceKind kind);

struct CalibrationAdvice {
  CalibrationAdviceKind kind{};
  FactValues values{};
};

}  // namespace kinfer
