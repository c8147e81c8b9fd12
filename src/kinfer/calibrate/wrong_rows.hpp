// Rows whose measurement is wrong, so that no model is to be judged by them: the same rows for every model that is
// tried, found before the rows are split.
#pragma once

#include "kinfer/calibrate/figures.hpp"
#include "kinfer/calibrate/single_fit.hpp"

namespace kinfer {

/// Rows that no noise explains beside the geometry alone, fitted robustly to all rows; rows held out among them, which
/// are looked at for this and nothing else. `geometry` is the fit of the plan's fitted rows.
Result<std::vector<Outlier>> wrong_beside_geometry(const CalibrateTask& task, const RowsPlan& plan,
                                                   const ParameterChoice& parameters, const Estimate& geometry,
                                                   Rng rng);

/// Rows that the richest model too puts far beyond its (smaller) noise, although it was fitted to them, and that
/// geometry alone puts no nearer: a model that throws a row out of place which geometry explains is wrong itself.
std::vector<Outlier> wrong_beside_both(const Estimate& geometry, const Estimate& richest, const PoseSet& rows);

/// Those of `wrong` that the chosen model does not put where they were measured either: what a model predicts is right,
/// however far geometry alone is off.
std::vector<Outlier> without_explained(const std::vector<Outlier>& wrong, const Estimate& chosen, const PoseSet& fitted,
                                       const PoseSet& data);

/// What the held-out figures leave out.
struct LeftOut {
  std::vector<int> rows;    ///< of the data, ascending
  bool too_many = false;    ///< a third of what was held out looks wrong: this is the model's fault, and all count
  std::size_t looking = 0;  ///< held-out rows that look wrong
};
LeftOut left_out_of_figures(const std::vector<Outlier>& wrong, const RowsPlan& plan);

}  // namespace kinfer
