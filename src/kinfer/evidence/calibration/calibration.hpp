// SPDX-License-Identifier: Apache-2.0
// The result of a calibration: the estimate, its validation on held-out poses, the verdict and the recommendations.
#pragma once

#include <limits>
#include <optional>

#include "kinfer/evidence/calibration/calibration_facts.hpp"
#include "kinfer/evidence/calibration/calibration_plot.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"
#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/evidence/calibration/unknown_robot.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer {

/// Position errors of one measured row for three chains [m]; NaN where the row's position was not measured.
struct RowErrors {
  int row = 0;          ///< from 0
  double before = 0.0;  ///< nominal chain, base and tool refitted (on other rows)
  double after = 0.0;   ///< where `held_out`: of a fit without this row; else of the final chain
  double fitted = 0.0;  ///< of the final chain
  bool held_out = false;
};

/// ISO 9283 figures of one commanded pose: the rows whose joint positions agree within 1e-4 rad or 0.01 mm.
struct PoseAccuracy {
  std::vector<int> rows;
  double accuracy_before = 0.0;  ///< AP [m]: distance from the measurements' centroid to the tool of `before`
  double accuracy_after = 0.0;   ///< AP [m] of the corrected chain
  std::optional<double>
      repeatability;  ///< RP [m]: mean distance from the centroid + 3 sd of it; only where rows repeat a pose
};

/// What the calibration started from.
struct NominalModel {
  Chain chain{};  ///< as given; the earlier calibration in a refit; estimated where there is no data sheet
  Tolerances tolerances{};
};

struct Calibration {
  NominalModel nominal_model;
  Estimate estimate;  ///< the corrected chain
  ChainFit nominal;   ///< the chain as given
  ChainFit before;    ///< base and tool refitted, everything else nominal
  ChainFit after;
  ModelSelection model_selection;                        ///< empty where no model selection was run
  MeasurementKind measured = kind_of<PointMeasurement>;  ///< what the position errors refer to
  HoldoutScheme holdout{};
  std::vector<int> gross_error_rows;  ///< held-out rows with gross errors, excluded from all hold-out figures
  std::vector<RowErrors> rows;
  std::vector<PoseAccuracy> accuracy;  ///< in the order of each pose's first row; empty without measured tool points
  CalibrationPlotData plot_data;       ///< data for the plots
  std::vector<CalibrationAdvice> recommendations;       ///< what to measure or to do next, most useful first
  std::vector<Finding> findings;                        ///< of the diagnosis before the fit
  std::vector<CalibrationNote> notes;                   ///< observations and automatic decisions
  std::optional<UnknownRobotEvidence> unknown_robot{};  ///< where the robot has no data sheet
  bool geometry_only = false;                           ///< found by a swarm search, which has no model selection
  std::optional<PredictionModel> prediction{};          ///< uncertainty of the corrected chain; none without points
  std::optional<double> expected_holdout_rms{};  ///< [m] from the instrument's noise and the uncertainty of the fits
  std::optional<double> noise_holdout_rms{};     ///< [m] the same if that noise were all that is wrong
  double tolerance_factor = 1.0;  ///< [1] by which the fit found the tolerances of the nominal model too small
  /// Largest error [m], or [rad] of orientations, that the tolerances of the nominal model could make; infinite where
  /// that is not known.
  double tolerated_error = std::numeric_limits<double>::infinity();
  bool noise_is_stated = true;  ///< the instrument's, in the unit of `tolerated_error`
  std::optional<double>
      predicted_holdout_rms{};  ///< [m] the same with the model error of `prediction`; none where that is not known
  /// Probability with which a model that is no better than the nominal one looks as much better on as many held-out
  /// poses (one-sided paired t test); none where no lengths were held out.
  std::optional<double> chance_of_improvement{};
  std::optional<UnobservedLengths> unobserved_lengths{};
  std::optional<Contradiction> contradiction{};  ///< of the kind that is contradicted most
  /// [1] how far the corrected tool moves over how far the nominal one does, along the direction in which it lost most.
  double least_motion = 1.0;
  Usability usability = Usability::use;
  CalibrationReason reason = CalibrationReason::improves_nominal;
};

/// The corrected chain as it is written to files: with all small rotations folded into the frames.
Chain corrected_chain(const Calibration& calibration);

/// Whether lengths were measured; else the figures are those of the orientations.
bool has_lengths(const Calibration& calibration);

/// The errors that the verdict compares: of lengths, or of orientations where nothing else was measured; of held-out
/// rows where there are some.
const ErrorStatistics& reported_errors(const Calibration& calibration, const ChainFit& fit);

/// The errors of the final chain on the rows that it was fitted to, of the same kind.
const ErrorStatistics& final_errors(const Calibration& calibration);

/// AP and RP of ISO 9283 over all poses [m]; RP over the repeated ones only.
struct AccuracyStatistics {
  ErrorStatistics before, after, repeatability;
};
AccuracyStatistics accuracy_statistics(const std::vector<PoseAccuracy>& poses);

}  // namespace kinfer
