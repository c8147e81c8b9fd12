#include "kinfer/calibrate/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kinfer {
namespace {

std::string millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}

const ErrorStatistics& judged(const TrainHoldout& position) {
  return position.holdout.n > 0 ? position.holdout : position.train;
}

std::string left_out(const Calibration& calibration) {
  const auto n = calibration.estimate.outliers.size();
  return n == 0 ? "" : fmt::format("; {} row{} not believed and left out", n, n == 1 ? " is" : "s are");
}

}  // namespace

void judge(Calibration& calibration, std::optional<double> expected) {
  const ErrorStatistics& before = judged(calibration.before.position);
  const ErrorStatistics& after = judged(calibration.after.position);
  constexpr double excuse = 3.0;  // times what is expected: beyond it, something is not modelled

  const std::string figures =
      fmt::format("on poses that were not fitted the tool is {} off on average and {} at worst ({} and {} before){}",
                  millimetres(after.mean), millimetres(after.max), millimetres(before.mean), millimetres(before.max),
                  left_out(calibration));
  const bool better = after.mean < before.mean;
  const bool excused = !expected || after.rms <= excuse * *expected;
  calibration.use = better && excused;
  if (!better) {
    calibration.verdict = "Do not use: the corrected model is no better than the nominal one: " + figures + ".";
  } else if (!excused) {
    calibration.verdict = fmt::format(
        "Do not use without a look: better, but the errors are {:.0f} times what instrument and fit can excuse, so "
        "something is "
        "not modelled: {}.",
        after.rms / *expected, figures);
  } else {
    calibration.verdict = "Use it: " + figures + ".";
  }
}

}  // namespace kinfer
