// SPDX-License-Identifier: Apache-2.0
// How well a chain explains measurements: the error figures that are printed, compared and evaluated.
#pragma once

#include <span>
#include <vector>

#include "kinfer/measurement/measurements.hpp"

namespace kinfer {

struct ErrorStatistics {
  double mean = 0.0, rms = 0.0, sd = 0.0, max = 0.0;  ///< [m] for positions, [rad] for orientations
  int n = 0;
};
ErrorStatistics error_statistics(std::span<const double> errors);

/// Errors on fitted rows and on held-out rows.
struct TrainHoldout {
  ErrorStatistics train;
  ErrorStatistics holdout;           ///< without the rows with gross errors (Calibration::gross_error_rows)
  ErrorStatistics holdout_all_rows;  ///< with them
};

/// Errors of one chain on one data set; n = 0 where nothing of the kind was measured.
struct ChainFit {
  TrainHoldout position;     ///< [m] Euclidean error of the measured points
  TrainHoldout orientation;  ///< [rad] angle between measured and predicted orientation
};

/// A measurement that the fit rejects as an outlier.
struct OutlierReason {
  MeasurementKind kind = kind_of<PointMeasurement>;
  double residual = 0.0;  ///< [m], [rad], or [m/s²] of a tilt
  double sigmas = 0.0;    ///< in units of the noise
};

/// A row with rejected measurements.
struct Outlier {
  int row = 0;   ///< from 0
  int line = 0;  ///< of the file, from 1
  std::vector<OutlierReason> reasons{};
  double sigmas = 0.0;    ///< of its worst measurement
  bool held_out = false;  ///< a held-out row with a gross error
};

}  // namespace kinfer
