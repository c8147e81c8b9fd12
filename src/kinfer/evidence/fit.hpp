// How well a chain explains measurements: the figures that are printed, compared and judged.
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

/// Errors on rows that were fitted and on rows that were not.
struct TrainHoldout {
  ErrorStatistics train;
  ErrorStatistics holdout;           ///< without the rows that are wrong (Calibration::wrong_rows)
  ErrorStatistics holdout_all_rows;  ///< with them
};

/// One chain on one data set. Orientation and distance figures have n = 0 where nothing of the kind was measured.
struct ChainFit {
  TrainHoldout position;     ///< [m] Euclidean error of the measured points
  TrainHoldout orientation;  ///< [rad] angle between measured and predicted orientation
};

/// A row that the fit does not believe.
struct Outlier {
  int row = 0;          ///< from 0
  int line = 0;         ///< of the file, from 1
  std::string reason;   ///< "the point is 4.21 mm from where the model has it, 84 sigma"
  double sigmas = 0.0;  ///< in noise, of its worst measurement
};

}  // namespace kinfer
