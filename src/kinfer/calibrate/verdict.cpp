#include "kinfer/calibrate/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/calibrate/doctor_case.hpp"

namespace kinfer {
namespace {

std::string millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}
std::string degrees(double radians) {
  return fmt::format("{:.3f} deg", radians / degree);
}

const ErrorStatistics& judged(const TrainHoldout& errors) {
  return errors.holdout.n > 0 ? errors.holdout : errors.train;
}

std::string rows_are(std::size_t n) {
  return fmt::format("{} row{}", n, n == 1 ? " is" : "s are");
}

/// Which rows the figures do not count, what they would be with them, and how many more the fit gives no weight.
std::string left_out(const Calibration& calibration, const std::string& worst_of_all) {
  const std::size_t listed = calibration.estimate.outliers.size(), wrong = calibration.wrong_rows.size();
  if (wrong == 0) return listed == 0 ? "" : "; " + rows_are(listed) + " not believed and left out of the fit";
  std::string text = fmt::format("; {} not believed and left out: {} ({} at worst with {})", rows_are(wrong),
                                 rows_in_words(calibration.wrong_rows), worst_of_all, wrong == 1 ? "it" : "them");
  const std::size_t more = listed - wrong;
  return more == 0 ? text : text + fmt::format("; the fit gives {} more row{} no weight", more, more == 1 ? "" : "s");
}

/// "position" is said of the tool; other measurements by their own name.
std::string subject(const Calibration& calibration) {
  return calibration.measured == "position" ? "the tool is" : fmt::format("the {} is", calibration.measured);
}

/// What the verdict compares: positions, or orientations where nothing else was measured.
struct Compared {
  ErrorStatistics before, after, written;
  std::string figures;
};

Compared compared(const Calibration& calibration) {
  const bool lengths = calibration.after.position.train.n > 0;
  const auto kind = lengths ? &ChainFit::position : &ChainFit::orientation;
  const auto show = lengths ? millimetres : degrees;
  Compared c{judged(calibration.before.*kind), judged(calibration.after.*kind), (calibration.after.*kind).train, ""};
  c.figures =
      fmt::format("on poses that were not fitted {} {} off on average and {} at worst ({} and {} before){}",
                  subject(calibration), show(c.after.mean), show(c.after.max), show(c.before.mean), show(c.before.max),
                  left_out(calibration, show((calibration.after.*kind).holdout_all_rows.max)));
  if (calibration.geometry_alone) c.figures += "; geometry alone, for population methods climb no ladder of models";
  return c;
}

}  // namespace

void judge(Calibration& calibration, std::optional<double> expected) {
  constexpr double excuse = 3.0;  // times what is expected: beyond it, something is not modelled
  // The chain that is written has seen more rows than the fits that prove it: it must fit its rows as well as they do
  // theirs, or it is another solution than the proven one.
  constexpr double same_solution = 1.5;
  const Compared c = compared(calibration);
  const bool better = c.after.mean < c.before.mean;
  const bool proven = c.written.rms <= same_solution * c.after.rms;
  const bool excused = !expected || c.after.rms <= excuse * *expected;
  calibration.use = better && proven && excused;
  if (!better) {
    calibration.verdict = "Do not use: the corrected model is no better than the nominal one: " + c.figures + ".";
  } else if (!proven) {
    calibration.verdict = fmt::format(
        "Do not use: the fit of all rows is {:.1f} times worse on them than the fits that prove it are on rows that "
        "they have not seen; {}.",
        c.written.rms / c.after.rms, c.figures);
  } else if (!excused) {
    calibration.verdict = fmt::format(
        "Do not use without a look: better, but the errors are {:.0f} times what instrument and fit can excuse, so "
        "something is not modelled: {}.",
        c.after.rms / *expected, c.figures);
  } else {
    calibration.verdict = "Use it: " + c.figures + ".";
  }
}

}  // namespace kinfer
