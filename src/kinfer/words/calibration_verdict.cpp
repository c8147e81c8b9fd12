// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kinfer/words/calibration.hpp"
#include "kinfer/words/calibration_outliers.hpp"
#include "kinfer/words/language.hpp"
#include "kinfer/words/row_ranges.hpp"

namespace kinfer::words {
namespace {

std::string millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}
std::string degrees(double radians) {
  return fmt::format("{:.3f} deg", radians / degree);
}

std::string rows_are(std::size_t n) {
  return fmt::format("{} row{}", n, n == 1 ? " is" : "s are");
}

/// Which rows are excluded from the figures, the worst error with them, and how many more rows the fit gives no weight.
std::string excluded_rows_text(const Calibration& c, const std::string& worst_of_all) {
  const std::size_t listed = c.estimate.outliers.size(), wrong = c.gross_error_rows.size();
  if (wrong == 0) return listed == 0 ? "" : "; " + rows_are(listed) + " not believed and left out of the fit";
  std::string text = fmt::format("; {} not believed and left out: {} ({} at worst with {})", rows_are(wrong),
                                 row_ranges(c.gross_error_rows), worst_of_all, wrong == 1 ? "it" : "them");
  const std::size_t more = listed - wrong;
  return more == 0 ? text : text + fmt::format("; the fit gives {} more row{} no weight", more, more == 1 ? "" : "s");
}

/// "the tool" for positions; other measurements by their own name.
std::string subject(const Calibration& c) {
  return c.measured == MeasurementKind::point ? "the tool is" : fmt::format("the {} is", measured_quantity(c.measured));
}

std::string figures(const Calibration& c) {
  const bool lengths = has_lengths(c);
  const auto show = lengths ? millimetres : degrees;
  const ErrorStatistics &before = reported_errors(c, c.before), &after = reported_errors(c, c.after);
  const TrainHoldout& errors = lengths ? c.after.position : c.after.orientation;
  std::string text =
      fmt::format("on poses that were not fitted {} {} off on average and {} at worst ({} and {} before){}", subject(c),
                  show(after.mean), show(after.max), show(before.mean), show(before.max),
                  excluded_rows_text(c, show(errors.holdout_all_rows.max)));
  if (c.geometry_only) text += "; geometry alone: a swarm search has no model selection";
  return text;
}

std::string figures_without_nominal(const Calibration& c) {
  const ErrorStatistics &train = c.after.position.train, &holdout = c.after.position.holdout;
  return fmt::format(
      "the robot was found without a data sheet; on poses that were not fitted the tool is {} off on average and {} at "
      "worst, on fitted ones {} on average",
      millimetres(holdout.mean), millimetres(holdout.max), millimetres(train.mean));
}

}  // namespace

std::string verdict_headline(const Calibration& calibration) {
  if (calibration.usability != Usability::do_not_use) return "Use it";
  return calibration.reason == CalibrationReason::unmodelled_effects ? "Do not use without a look" : "Do not use";
}

std::string verdict(const Calibration& c) {
  const std::string_view id = name(c.reason);
  const std::string headline = verdict_headline(c);
  switch (c.reason) {
    case CalibrationReason::improves_nominal:
      return phrase(id, "{}: {}.", headline, figures(c));
    case CalibrationReason::no_improvement:
      return phrase(id, "{}: the corrected model is no better than the nominal one: {}.", headline, figures(c));
    case CalibrationReason::not_validated:
      return phrase(id,
                    "{}: the fit of all rows is {:.1f} times worse on them than the fits that validate it are on rows "
                    "that they have not seen; {}.",
                    headline, final_errors(c).rms / reported_errors(c, c.after).rms, figures(c));
    case CalibrationReason::unmodelled_effects:
      return phrase(id,
                    "{}: better, but the errors are {:.0f} times what instrument and fit can excuse, so something is "
                    "not modelled: {}.",
                    headline, reported_errors(c, c.after).rms / *c.expected_holdout_rms, figures(c));
    case CalibrationReason::generalises:
    case CalibrationReason::overfitted:
      return phrase(id, "{}: {}.", headline, figures_without_nominal(c));
  }
  return "";
}

}  // namespace kinfer::words
