// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/verify.hpp"

#include <cmath>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer::deploy {
namespace {

std::string in_millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}

double typical_point_sd(const Instrument& instrument, const PoseSet& data) {
  double squares = 0.0;
  for (const PointMeasurement& point : data.points) squares += std::pow(position_sd(instrument, point.position), 2);
  return std::sqrt(3.0 * squares / static_cast<double>(data.points.size()));
}

}  // namespace

Result<Verification> verify(const Chain& given_chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& given_data) {
  if (given_data.points.empty()) return error("the data contain no measured positions to verify against");
  KINFER_TRY(placed, calibrate::with_fixtures(given_chain, given_data));
  const Chain& chain = placed.chain;
  const PoseSet data = with_approach(placed.data);
  Verification v;
  v.unmodified = error_statistics(point_errors(chain, data));
  KINFER_TRY(refitted, calibrate::fit_frames_only({chain, tolerances, instrument, data}, data));
  v.frames_refitted = error_statistics(point_errors(refitted, data));

  constexpr double noise_ratio = 3.0;  // times the instrument's noise
  const double error_limit = instrument ? noise_ratio * std::max(typical_point_sd(*instrument, data), 1e-8) : 0.0;
  const bool moved = v.frames_refitted.rms <= (instrument ? error_limit : 0.5 * v.unmodified.rms);
  v.good = instrument ? v.unmodified.rms <= error_limit : !moved;
  const std::string figures = fmt::format("the tool is {} off on average and {} at worst",
                                          in_millimetres(v.unmodified.mean), in_millimetres(v.unmodified.max));
  if (v.good)
    v.verdict = fmt::format("Still good: {}.", figures);
  else if (moved)
    v.verdict = fmt::format(
        "Not good as it stands: {}; with base and tool refitted {} on average, so the instrument or the "
        "tool was moved rather than the robot changed.",
        figures, in_millimetres(v.frames_refitted.mean));
  else
    v.verdict = fmt::format(
        "Not good any more: {}, more than the instrument can excuse, and refitting base and tool does not "
        "cure it ({}). Calibrate again.",
        figures, in_millimetres(v.frames_refitted.mean));
  return v;
}

}  // namespace kinfer::deploy
