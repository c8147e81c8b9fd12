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

/// The data as the chain with all its corrections would have them: what these fade by outside the measured region is
/// taken from each point, along the axes of the base that `placed` has.
PoseSet without_fading(PoseSet data, const Chain& chain, const Chain& placed,
                       const std::optional<PredictionModel>& prediction) {
  if (!prediction || prediction->beyond.size() == 0) return data;
  const std::vector<Pose> with = predicted_poses(chain, std::nullopt, data),
                          faded = predicted_poses(chain, prediction, data);
  const auto turn_of = [&](int row) {
    const int mounting = data.mounting.empty() ? -1 : data.mounting[static_cast<std::size_t>(row)];
    return Mat3(with_mounting(placed, mounting).base.pose().rotation *
                with_mounting(chain, mounting).base.pose().rotation.transpose());
  };
  for (PointMeasurement& point : data.points) {
    const Vec3 target = point.target < 0 ? Vec3::Zero().eval() : Vec3(chain.targets[point.target].xyz);
    point.position -= turn_of(point.row) * (faded[point.row] * target - with[point.row] * target);
  }
  for (OrientationMeasurement& measured : data.orientations) {
    const Mat3 turn = turn_of(measured.row);
    const Mat3 fading =
        turn * faded[measured.row].rotation * with[measured.row].rotation.transpose() * turn.transpose();
    measured.orientation = Quat(fading.transpose()) * measured.orientation;
  }
  return data;
}

/// As stated, or as noisy as in the calibration.
std::optional<Instrument> known_instrument(const std::optional<Instrument>& stated,
                                           const std::optional<PredictionModel>& prediction) {
  if (stated || !prediction || !(prediction->noise > 0.0)) return stated;
  return Instrument{.sigma = prediction->noise};
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
  v.unmodified = error_statistics(point_errors(chain, without_fading(data, chain, chain, prediction)));
  const auto refit_frames = [&](const PoseSet& rows) {
    return calibrate::fit_frames_only(
        {.nominal = chain, .tolerances = tolerances, .instrument = instrument, .data = rows}, rows);
  };
  KINFER_TRY(placed_by_all, refit_frames(data));
  const PoseSet unfaded = without_fading(data, chain, placed_by_all, prediction);
  KINFER_TRY(refitted, refit_frames(unfaded));
  v.frames_refitted = error_statistics(point_errors(refitted, unfaded));

  const std::optional<Instrument> known = known_instrument(instrument, prediction);
  v.noise_is_known = known.has_value();
  if (known) {
    const double sd = std::max(expected_rms(chain, *known, data, prediction), thresholds::least_point_sd);
    v.result = judge_by_noise(v, thresholds::noise_ratio * sd);
  } else {
    v.result = v.frames_refitted.rms <= thresholds::refit_ratio * v.unmodified.rms ? VerificationResult::frames_moved
                                                                                   : VerificationResult::valid;
  }
  return v;
}

}  // namespace kinfer::deploy
