// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/moving_points.hpp"

#include <algorithm>

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

Changes of_points(const CalibrationTask& task, const std::vector<Pose>& poses) {
  std::vector<Vec3> predicted;
  for (const PointMeasurement& point : task.data.points)
    predicted.push_back(poses[static_cast<std::size_t>(point.row)] *
                        (point.target < 0 ? Vec3::Zero().eval() : Vec3(task.nominal.targets[point.target].xyz)));
  return {rms_spread(point_positions(task.data)), rms_spread(predicted)};
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

}  // namespace

Result<void> expect_moving_points(const CalibrationTask& task) {
  const PoseSet& data = task.data;
  const bool has_points = data.points.size() >= thresholds::min_points_of_quick_fit;
  if (!data.mounting.empty() || (!has_points && (!data.points.empty() || data.distances.empty()))) return {};
  const std::vector<Pose> poses = predicted_poses(task.nominal, std::nullopt, data);
  const std::optional<Changes> change = has_points ? of_points(task, poses) : of_distances(task, poses);
  if (!change || change->measured > thresholds::still_points * change->predicted ||
      change->predicted < max_plausible_error(task))
    return {};
  return error(
      "the measured {0} (by {1:.3g} mm), although the joints change {2} by {3:.3g} mm: the columns repeat one value",
      has_points ? "points never move" : "distances never change", 1e3 * change->measured,
      has_points ? "the tool's place" : "them", 1e3 * change->predicted);
}

}  // namespace kinfer::calibrate
