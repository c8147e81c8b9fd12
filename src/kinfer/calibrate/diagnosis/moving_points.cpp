// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/moving_points.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"
#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

/// [m] of what was measured, and of the same by the nominal model.
struct Changes {
  double measured = 0.0, predicted = 0.0;
};

std::vector<Vec3> predicted_points(const CalibrationTask& task, const std::vector<Pose>& poses) {
  std::vector<Vec3> predicted;
  for (const PointMeasurement& point : task.data.points)
    predicted.push_back(poses[static_cast<std::size_t>(point.row)] *
                        (point.target < 0 ? Vec3::Zero().eval() : Vec3(task.nominal.targets[point.target].xyz)));
  return predicted;
}

Changes of_points(const CalibrationTask& task, const std::vector<Pose>& poses) {
  return {rms_spread(point_positions(task.data)), rms_spread(predicted_points(task, poses))};
}

/// Along the principal axis on which the points change least against the prediction.
Changes along_one_direction(const CalibrationTask& task, const std::vector<Pose>& poses, double feigned) {
  const Vec3 measured = principal_spread(point_positions(task.data)),
             predicted = principal_spread(predicted_points(task, poses));
  Changes least{1.0, 0.0};
  for (int k = 0; k < 3; ++k)
    if (predicted[k] > feigned && measured[k] * least.predicted < least.measured * predicted[k])
      least = {measured[k], predicted[k]};
  return least;
}

/// Of the anchor whose distances change most; none where one has but a few.
std::optional<Changes> of_distances(const CalibrationTask& task, const std::vector<Pose>& poses) {
  const std::vector<Vec3>& anchors = task.nominal.fixtures.anchors;
  std::vector<std::vector<double>> measured(anchors.size()), predicted(anchors.size());
  for (const DistanceMeasurement& at : task.data.distances) {
    const auto anchor = static_cast<std::size_t>(at.anchor);
    const Vec3 place = task.nominal.base.pose() * anchors[anchor];
    measured[anchor].push_back(at.distance);
    predicted[anchor].push_back((poses[static_cast<std::size_t>(at.row)].position - place).norm());
  }
  Changes most;
  for (std::size_t anchor = 0; anchor < anchors.size(); ++anchor) {
    if (measured[anchor].size() < thresholds::min_points_of_quick_fit) return std::nullopt;
    most.measured = std::max(most.measured, standard_deviation(measured[anchor]));
    most.predicted = std::max(most.predicted, standard_deviation(predicted[anchor]));
  }
  return most;
}

/// Of one station: rms angle of its directions about their mean [rad], and by how much the tool moves across any line
/// of sight [m].
struct Sights {
  int station = 0;
  double angle = 0.0, across = 0.0;
};

std::vector<Sights> sights_of_stations(const PoseSet& data, const std::vector<Pose>& poses) {
  std::vector<Sights> all;
  for (int station = 0; station < static_cast<int>(data.stations.size()); ++station) {
    std::vector<Vec3> directions, points;
    for (const DirectionMeasurement& seen : data.directions)
      if (seen.station == station)
        directions.push_back(seen.direction), points.push_back(poses[static_cast<std::size_t>(seen.row)].position);
    if (directions.size() >= thresholds::min_points_of_quick_fit)
      all.push_back({station, rms_spread(directions), principal_spread(points)[1]});
  }
  return all;
}

Result<void> expect_changing_points(const CalibrationTask& task, const std::vector<Pose>& poses, double feigned) {
  const auto still = [&](const Changes& c) {
    return c.measured <= thresholds::still_points * c.predicted && c.predicted > feigned;
  };
  if (const Changes all = of_points(task, poses); still(all))
    return error(
        "the measured points never move (by {:.3g} mm), although the joints change the tool's place by {:.3g} mm: the "
        "columns repeat one value",
        1e3 * all.measured, 1e3 * all.predicted);
  if (const Changes one = along_one_direction(task, poses, feigned); still(one))
    return error(
        "the measured points never move along one direction (by {:.3g} mm), although the joints move the tool by "
        "{:.3g} mm or more along every one: a column repeats one value",
        1e3 * one.measured, 1e3 * one.predicted);
  return {};
}

Result<void> expect_changing_distances(const CalibrationTask& task, const std::vector<Pose>& poses, double feigned) {
  const std::optional<Changes> change = of_distances(task, poses);
  if (!change || change->measured > thresholds::still_points * change->predicted || change->predicted < feigned)
    return {};
  return error(
      "the measured distances never change (by {:.3g} mm), although the joints change them by {:.3g} mm: the columns "
      "repeat one value",
      1e3 * change->measured, 1e3 * change->predicted);
}

Result<void> expect_changing_directions(const CalibrationTask& task, const std::vector<Pose>& poses, double feigned) {
  for (const Sights& seen : sights_of_stations(task.data, poses))
    if (seen.angle <= thresholds::still_points && seen.across > feigned)
      return error(
          "the directions from station {} never change (by {:.3g} mrad), although the joints move the tool by {:.3g} "
          "mm across any line of sight: the columns repeat one value",
          task.data.stations[static_cast<std::size_t>(seen.station)], 1e3 * seen.angle, 1e3 * seen.across);
  return {};
}

}  // namespace

Vec3 principal_spread(std::span<const Vec3> points) {
  const Vec3 centre = centroid(points);
  Mat3 sum = Mat3::Zero();
  for (const Vec3& point : points) sum += (point - centre) * (point - centre).transpose();
  return principal_deviations(sum / static_cast<double>(std::max<std::size_t>(1, points.size()))).sd;
}

Result<void> expect_moving_points(const CalibrationTask& task) {
  const PoseSet& data = task.data;
  if (!data.mounting.empty()) return {};
  const std::vector<Pose> poses = predicted_poses(task.nominal, std::nullopt, data);
  const double feigned = max_plausible_error(task);
  if (data.points.size() >= thresholds::min_points_of_quick_fit)
    if (auto moving = expect_changing_points(task, poses, feigned); !moving) return moving;
  if (data.points.empty() && !data.distances.empty())
    if (auto changing = expect_changing_distances(task, poses, feigned); !changing) return changing;
  return expect_changing_directions(task, poses, feigned);
}

}  // namespace kinfer::calibrate
