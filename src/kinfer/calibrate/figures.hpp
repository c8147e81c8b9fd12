// The figures of a calibration: errors before and after, on rows that were fitted and on rows that were not.
#pragma once

#include <optional>

#include "kinfer/calibrate/rows_plan.hpp"
#include "kinfer/estimate/bundle.hpp"
#include "kinfer/evidence/calibration.hpp"

namespace kinfer {

/// Two fits that have not seen the rows held out.
struct Proof {
  Chain before;    ///< base and tool refitted
  Estimate after;  ///< calibrated
};

/// The first of points, contacts, distances, ball-bars, planes that was measured: its errors are the headline [m].
/// Nothing where only orientations or tilts were.
std::optional<MeasurementKind> headline_kind(const PoseSet& data);
std::string_view headline_word(std::optional<MeasurementKind> kind);

/// Errors of the headline kind of `judged` by a chain that was fitted on `seen`.
std::vector<double> headline_errors(const Chain& chain, const PoseSet& seen, const PoseSet& judged);

/// Everything about the data that all figures need.
struct Judged {
  const Chain& nominal;
  const std::optional<Instrument>& instrument;
  const PoseSet& data;
  const RowsPlan& plan;
  const Chain& frames_only;
  const std::vector<Proof>& proofs;
  const std::vector<int>& wrong;  ///< held-out rows that are not counted
};

/// Fills nominal, before, after and rows from the final estimate (whose outliers count in the data's rows) and proofs.
void fill_figures(Calibration& calibration, const Judged& judged);

/// Rms error that the held-out rows should show [m]: the instrument's scatter and the uncertainty of the fits that did
/// not see them. Nothing where the instrument is not known.
std::optional<double> expected_error(const Judged& judged);

}  // namespace kinfer
