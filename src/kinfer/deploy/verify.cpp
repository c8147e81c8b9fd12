// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/verify.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/deploy/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"

namespace kinfer::deploy {
namespace {

/// Expected rms error of the points [m]: by the instrument, and by the calibration's own uncertainty where it is known.
double expected_rms(const Chain& chain, const Instrument& instrument, const PoseSet& data,
                    const std::optional<PredictionModel>& prediction) {
  const auto uncertainties =
      prediction ? pose_uncertainties(chain, *prediction, data) : std::vector<PoseUncertainty>(data.rows());
  double squares = 0.0;
  for (const PointMeasurement& point : data.points)
    squares += 3.0 * std::pow(position_sd(instrument, point.position), 2) + uncertainties[point.row].position.trace();
  return std::sqrt(squares / static_cast<double>(data.points.size()));
}

VerificationResult judge_by_noise(const Verification& v, double limit) {
  if (v.unmodified.rms <= limit) return VerificationResult::valid;
  return v.frames_refitted.rms <= limit ? VerificationResult::frames_moved : VerificationResult::robot_changed;
}

}  // namespace

Result<Verification> verify(const Chain& given_chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& given_data,
                            const std::optional<PredictionModel>& prediction) {
  if (given_data.points.empty()) return error("the data contain no measured positions to verify against");
  KINFER_TRY(placed, calibrate::with_fixtures(given_chain, given_data));
  const Chain& chain = placed.chain;
  const PoseSet data = with_approach(placed.data);
  Verification v;
  v.unmodified = error_statistics(point_errors(chain, data));
  KINFER_TRY(refitted, calibrate::fit_frames_only(
                           {.nominal = chain, .tolerances = tolerances, .instrument = instrument, .data = data}, data));
  v.frames_refitted = error_statistics(point_errors(refitted, data));

  if (instrument) {
    const double sd = std::max(expected_rms(chain, *instrument, data, prediction), thresholds::least_point_sd);
    v.result = judge_by_noise(v, thresholds::noise_ratio * sd);
  } else {
    v.result = v.frames_refitted.rms <= thresholds::refit_ratio * v.unmodified.rms ? VerificationResult::frames_moved
                                                                                   : VerificationResult::valid;
  }
  return v;
}

}  // namespace kinfer::deploy
