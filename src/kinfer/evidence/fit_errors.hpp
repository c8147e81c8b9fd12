// SPDX-License-Identifier: Apache-2.0
// How well a chain explains measurements: the error figures that are printed, compared and evaluated.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace kinfer {

struct ErrorStatistics {
  double mean = 0.0, rms = 0.0, sd = 0.0, max = 0.0;  ///< [m] for positions, [rad] for orientations
  int n = 0;
};
ErrorStatistics error_statistics(std::span<const double> errors);

/// Errors on fitted rows and on held-out rows.
struct TrainHoldout {
  ErrorStatistics train;
  ErrorStatistics holdout;           ///< without the rows with gross errors (Calibration::wrong_rows)
  ErrorStatistics holdout_all_rows;  ///< with them
};

/// Errors of one chain on one data set; n = 0 where nothing of the kind was measured.
struct ChainFit {
  TrainHoldout position;     ///< [m] Euclidean error of the measured points
  TrainHoldout orientation;  ///< [rad] angle between measured and predicted orientation
};

/// A row that the fit rejects as an outlier.
struct Outlier {
  int row = 0;          ///< from 0
  int line = 0;         ///< of the file, from 1
  std::string reason;   ///< "the point is 4.21 mm from where the model has it, 84 sigma"
  double sigmas = 0.0;  ///< residual of its worst measurement in units of the noise
};

}  // namespace kinfer
