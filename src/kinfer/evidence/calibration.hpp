// SPDX-License-Identifier: Apache-2.0
// The result of a calibration: the estimate, its validation on held-out poses, the verdict and the recommendations.
#pragma once

#include <optional>

#include "kinfer/evidence/advice.hpp"
#include "kinfer/evidence/calibration_plot.hpp"
#include "kinfer/evidence/estimate.hpp"
#include "kinfer/evidence/findings.hpp"
#include "kinfer/evidence/model_selection.hpp"

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

struct Calibration {
  Estimate estimate;  ///< the corrected chain
  ChainFit nominal;   ///< the chain as given
  ChainFit before;    ///< base and tool refitted, everything else nominal
  ChainFit after;
  ModelSelection model_selection;     ///< empty where no model selection was run
  std::string measured = "position";  ///< what the position errors refer to: "ball in socket", "distance", …
  std::string holdout;                ///< hold-out scheme: "5-fold cross-validation"
  std::vector<int> gross_error_rows;  ///< held-out rows with gross errors, excluded from all hold-out figures
  std::vector<RowErrors> rows;
  std::vector<PoseAccuracy> accuracy;   ///< in the order of each pose's first row; empty without measured tool points
  CalibrationPlotData plot_data;        ///< data for the plots
  std::vector<Advice> recommendations;  ///< what to measure or to do next, most useful first
  std::vector<Finding> findings;        ///< of the diagnosis before the fit
  std::vector<std::string> notes;       ///< observations and automatic decisions, in words
  bool geometry_only = false;           ///< found by a swarm search, which has no model selection
  bool usable = true;                   ///< false: the verdict advises against using the result
  std::string verdict;                  ///< one sentence
};

}  // namespace kinfer
