// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

namespace kinfer::calibrate {
namespace {

std::string millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}
std::string degrees(double radians) {
  return fmt::format("{:.3f} deg", radians / degree);
}

const ErrorStatistics& reported(const TrainHoldout& errors) {
  return errors.holdout.n > 0 ? errors.holdout : errors.train;
}

std::string rows_are(std::size_t n) {
  return fmt::format("{} row{}", n, n == 1 ? " is" : "s are");
}

/// Which rows are excluded from the figures, the worst error with them, and how many more rows the fit gives no weight.
std::string excluded_rows_text(const Calibration& calibration, const std::string& worst_of_all) {
  const std::size_t listed = calibration.estimate.outliers.size(), wrong = calibration.gross_error_rows.size();
  if (wrong == 0) return listed == 0 ? "" : "; " + rows_are(listed) + " not believed and left out of the fit";
  std::string text = fmt::format("; {} not believed and left out: {} ({} at worst with {})", rows_are(wrong),
                                 describe_rows(calibration.gross_error_rows), worst_of_all, wrong == 1 ? "it" : "them");
  const std::size_t more = listed - wrong;
  return more == 0 ? text : text + fmt::format("; the fit gives {} more row{} no weight", more, more == 1 ? "" : "s");
}

/// "the tool" for positions; other measurements by their own name.
std::string subject(const Calibration& calibration) {
  return calibration.measured == "position" ? "the tool is" : fmt::format("the {} is", calibration.measured);
}

/// The statistics that the verdict compares: positions, or orientations where nothing else was measured.
struct ErrorComparison {
  ErrorStatistics before, after, final_fit;
  std::string figures;
};

ErrorComparison compare_errors(const Calibration& calibration) {
  const bool lengths = calibration.after.position.train.n > 0;
  const auto kind = lengths ? &ChainFit::position : &ChainFit::orientation;
  const auto show = lengths ? millimetres : degrees;
  ErrorComparison c{reported(calibration.before.*kind), reported(calibration.after.*kind),
                    (calibration.after.*kind).train, ""};
  c.figures =
      fmt::format("on poses that were not fitted {} {} off on average and {} at worst ({} and {} before){}",
                  subject(calibration), show(c.after.mean), show(c.after.max), show(c.before.mean), show(c.before.max),
                  excluded_rows_text(calibration, show((calibration.after.*kind).holdout_all_rows.max)));
  if (calibration.geometry_only) c.figures += "; geometry alone, for population methods climb no ladder of models";
  return c;
}

}  // namespace

void write_verdict(Calibration& calibration, std::optional<double> expected) {
  constexpr double expectation_ratio = 3.0;  // times the expected error: above it, some effect is not modelled
  // The final chain is fitted to more rows than the fits that validate it. If it fits its rows much worse than they
  // predict theirs, it has converged to another solution than the validated one.
  constexpr double same_solution_ratio = 1.5;
  const ErrorComparison c = compare_errors(calibration);
  const bool better = c.after.mean < c.before.mean;
  const bool validated = c.final_fit.rms <= same_solution_ratio * c.after.rms;
  const bool within_expectation = !expected || c.after.rms <= expectation_ratio * *expected;
  calibration.usable = better && validated && within_expectation;
  if (!better) {
    calibration.verdict = "Do not use: the corrected model is no better than the nominal one: " + c.figures + ".";
  } else if (!validated) {
    calibration.verdict = fmt::format(
        "Do not use: the fit of all rows is {:.1f} times worse on them than the fits that prove it are on rows that "
        "they have not seen; {}.",
        c.final_fit.rms / c.after.rms, c.figures);
  } else if (!within_expectation) {
    calibration.verdict = fmt::format(
        "Do not use without a look: better, but the errors are {:.0f} times what instrument and fit can excuse, so "
        "something is not modelled: {}.",
        c.after.rms / *expected, c.figures);
  } else {
    calibration.verdict = "Use it: " + c.figures + ".";
  }
}

}  // namespace kinfer::calibrate
