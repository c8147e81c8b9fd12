// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/kind_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

bool is_angle_of_tool(MeasurementKind kind) {
  return kind == kind_of<OrientationMeasurement> || kind == kind_of<TiltMeasurement>;
}

/// The fit is blind to the sign of all tilts, which accelerometers and their readers choose differently: it is that of
/// most of them.
std::vector<double> tilt_errors(const Chain& chain, const PoseSet& data) {
  const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
  std::vector<double> errors;
  for (const TiltMeasurement& tilt : data.tilts)
    errors.push_back(
        angle_between(tilt.specific_force, -(at.pose[tilt.row].rotation.transpose() * chain.gravity).eval()));
  if (!errors.empty() && median(errors) > 90.0 * degree)
    for (double& error : errors) error = 180.0 * degree - error;
  return errors;
}

/// Metres at the tool point that one unit of each error is worth: the range of directions, else 1.
std::vector<double> metres_of_errors(const ResidualKind& kind, const Chain& chain, const PoseSet& data) {
  const ParameterSet nothing;
  const EvaluatedPoses at = evaluate_poses(chain, nothing, data, Derivative::no);
  const FixtureColumns columns = fixture_columns(chain, nothing);
  const ResidualContext scene{chain, data, at, columns};
  std::vector<double> metres(kind.count(data));
  for (std::size_t i = 0; i < metres.size(); ++i) metres[i] = kind.metres(scene, i);
  return metres;
}

/// Rms angle of each direction's station about the mean of its directions [rad].
std::vector<double> spread_of_stations(const PoseSet& data) {
  std::map<int, std::vector<Vec3>> seen;
  for (const DirectionMeasurement& m : data.directions) seen[m.station].push_back(m.direction);
  std::vector<double> spread;
  for (const DirectionMeasurement& m : data.directions) spread.push_back(rms_spread(seen[m.station]));
  return spread;
}

/// What each error of a kind may be if its noise is not stated: lengths nothing beyond the tolerances, angles
/// `unstated_noise_angle`, and directions a part of how much they change, which a station far away would not explain.
std::vector<double> largest_unstated_noise(const ResidualKind& kind, const PoseSet& data) {
  if (kind.traits.unit == ResidualUnit::length) return std::vector<double>(kind.count(data), 0.0);
  std::vector<double> largest(kind.count(data), thresholds::unstated_noise_angle);
  if (kind.kind != kind_of<DirectionMeasurement>) return largest;
  const std::vector<double> spread = spread_of_stations(data);
  for (std::size_t i = 0; i < largest.size(); ++i)
    largest[i] = std::min(largest[i], thresholds::plausible_improvement * spread[i]);
  return largest;
}

/// Stated standard deviations of each error; 0: none.
std::vector<double> stated_noise(const ResidualKind& kind, const CalibrationTask& task) {
  const Weights weights = weights_of(task.data, task.instrument.value_or(Instrument{}));
  const double unit = kind.kind == kind_of<TiltMeasurement> ? 1.0 / task.nominal.gravity.norm() : 1.0;
  std::vector<double> noise;
  for (const Vec3& sd : weights.of(kind.kind))
    noise.push_back(sd.maxCoeff() > noise_free_sd ? unit * sd.head(kind.size).norm() : 0.0);
  return noise;
}

/// What the tolerances of the nominal model could make of a tool point [m] and of an orientation [rad].
struct Tolerated {
  double length = 0.0, angle = 0.0;
};

/// Counts the measurements of one kind that neither its noise nor the tolerances explain.
Contradiction judge_kind(const ResidualKind& kind, const CalibrationTask& task, const Chain& chain,
                         const Tolerated& tolerated) {
  const std::vector<double> errors = kind.kind == kind_of<TiltMeasurement>
                                         ? tilt_errors(chain, task.data)
                                         : residual_norms(kind.kind, chain, task.data),
                            metres = metres_of_errors(kind, chain, task.data), noise = stated_noise(kind, task),
                            unstated = largest_unstated_noise(kind, task.data);
  Contradiction found{.kind = kind.kind, .measured = static_cast<int>(errors.size()), .error = rms(errors)};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double by_tolerances = is_angle_of_tool(kind.kind) ? tolerated.angle : tolerated.length / metres[i],
                 by_noise = noise[i] > 0.0 ? thresholds::explained_sigmas * noise[i] : unstated[i];
    if (!(errors[i] <= std::max(by_tolerances, by_noise))) ++found.contradicted;
  }
  found.noise = rms(noise);
  return found;
}

bool is_contradicted(const Contradiction& kind) {
  return kind.measured >= thresholds::min_judged_measurements &&
         static_cast<int>(thresholds::max_gross_part) * kind.contradicted > kind.measured;
}

}  // namespace

std::vector<double> errors_of_kind(MeasurementKind kind, const Chain& chain, const PoseSet& data) {
  if (kind == kind_of<TiltMeasurement>) return tilt_errors(chain, data);
  return is_angle_of_tool(kind) ? residual_norms(kind, chain, data) : position_errors(kind, chain, data);
}

std::optional<Contradiction> find_contradiction(const CalibrationTask& task, const Chain& chain,
                                                const PoseSet& fitted_rows) {
  const Chain judged = with_unfitted_fixtures(chain, fitted_rows, task.data);
  const Tolerated tolerated{max_plausible_error(task), max_plausible_angle(task)};
  std::vector<Contradiction> contradicted;
  std::size_t explained = 0;
  for (const ResidualKind& kind : residual_kinds()) {
    if (kind.count(task.data) == 0) continue;
    const Contradiction found = judge_kind(kind, task, judged, tolerated);
    if (is_contradicted(found))
      contradicted.push_back(found);
    else
      ++explained;
  }
  if (contradicted.empty() || explained == 0) return std::nullopt;
  return *std::ranges::max_element(contradicted, {}, [](const Contradiction& kind) {
    return static_cast<double>(kind.contradicted) / kind.measured;
  });
}

}  // namespace kinfer::calibrate
