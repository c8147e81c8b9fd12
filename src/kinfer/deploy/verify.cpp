// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/verify.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/deploy/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::deploy {
namespace {

/// Expected rms error of the points [m]: by the instrument, and by the calibration's own uncertainty where it is known.
double expected_rms(const Chain& chain, const Instrument& instrument, const PoseSet& data,
                    const std::optional<PredictionModel>& prediction) {
  const auto uncertainties =
      prediction ? pose_uncertainties(chain, *prediction, data) : std::vector<PoseUncertainty>(data.rows());
  double squares = 0.0;
  for (const PointMeasurement& point : data.points)
    squares += (point.sd ? point.sd->squaredNorm() : 3.0 * std::pow(position_sd(instrument, point.position), 2)) +
               uncertainties[point.row].position.trace();
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
  if (stated && stated->states_lengths()) return stated;
  if (!prediction || !(prediction->noise > 0.0)) return std::nullopt;
  return with_lengths(stated.value_or(Instrument{}), prediction->noise);
}

/// Of different poses and targets: a pose that was measured again tells no more about the robot, but in another
/// mounting it tells of the frames of that one.
int measured_numbers(const PoseSet& data) {
  const std::vector<int> poses = commanded_poses(data);
  const auto place_of = [&](int row) {
    const auto at = static_cast<std::size_t>(row);
    return std::pair(poses[at], data.mounting.empty() ? -1 : data.mounting[at]);
  };
  std::set<std::pair<std::pair<int, int>, int>> points;
  std::set<std::pair<int, int>> orientations;
  for (const PointMeasurement& point : data.points) points.emplace(place_of(point.row), point.target);
  for (const OrientationMeasurement& m : data.orientations) orientations.insert(place_of(m.row));
  return 3 * static_cast<int>(points.size() + orientations.size());
}

Result<void> expect_several_poses(const PoseSet& data) {
  const std::vector<int> poses = commanded_poses(data);
  if (data.rows() == 1 || std::ranges::max(poses) > 0) return {};
  return error("all {} rows were measured at the same joint positions, which tells nothing about others", data.rows());
}

/// rms error of the refit as of points that it had not seen: a refit to few points fits their noise, too.
double honest_rms(const Verification& v, const PoseSet& data) {
  return v.frames_refitted.rms * std::sqrt(static_cast<double>(measured_numbers(data)) / v.redundancy);
}

VerificationResult judge_by_noise(const Verification& v, const PoseSet& data, double limit) {
  if (v.unmodified.rms <= limit) return VerificationResult::valid;
  if (v.redundancy > 0 && honest_rms(v, data) > limit) return VerificationResult::robot_changed;
  return v.redundancy < thresholds::least_redundancy ? VerificationResult::moved_or_changed
                                                     : VerificationResult::frames_moved;
}

VerificationResult judge_by_refit(const Verification& v, const PoseSet& data) {
  return honest_rms(v, data) <= thresholds::refit_ratio * v.unmodified.rms ? VerificationResult::frames_moved
                                                                           : VerificationResult::valid;
}

}  // namespace

Result<Verification> verify(const Chain& given_chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& given_data,
                            const std::optional<PredictionModel>& prediction) {
  if (given_data.points.empty()) return error("the data contain no measured positions to verify against");
  KINFER_TRY(placed, calibrate::with_fixtures(given_chain, given_data));
  const Chain& chain = placed.chain;
  const PoseSet data = with_approach(with_commanded_poses(placed.data, chain));
  if (const auto several = expect_several_poses(data); !several) return forward_error(several.error());
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

  const auto unknowns = static_cast<int>(calibrate::frame_parameters(chain, data, tolerances).free_count());
  v.redundancy = measured_numbers(data) - unknowns;
  const std::optional<Instrument> known = known_instrument(instrument, prediction);
  v.noise_is_known = known.has_value();
  if (known) {
    // A chain that its calibration does not know is not valid because of that: its own uncertainty excuses no more than
    // the tolerances of a robot that was never calibrated.
    const double by_all = expected_rms(chain, *known, data, prediction),
                 by_noise = expected_rms(chain, *known, data, std::nullopt),
                 tolerated = calibrate::max_plausible_error(
                     {.nominal = chain, .tolerances = tolerances, .instrument = known, .data = data});
    const double sd =
        std::max({std::min(by_all, tolerated / thresholds::noise_ratio), by_noise, thresholds::least_point_sd});
    v.result = judge_by_noise(v, data, thresholds::noise_ratio * sd);
  } else {
    if (v.redundancy < thresholds::least_redundancy)
      return error(
          "{} measured numbers are too few to verify by: base and tool have {} unknowns, and [instrument] states no "
          "noise; measure more poses",
          measured_numbers(data), unknowns);
    v.result = judge_by_refit(v, data);
  }
  return v;
}

}  // namespace kinfer::deploy
