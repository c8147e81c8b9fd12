// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/orientation_conventions.hpp"

#include <algorithm>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// Median angle [rad] between measured and predicted orientations for the best-fitting tool rotation.
double median_misalignment(const std::vector<Mat3>& world_R_flange,
                           const std::vector<OrientationMeasurement>& measured) {
  std::vector<Mat3> tools;
  for (const OrientationMeasurement& m : measured)
    tools.push_back(world_R_flange[m.row].transpose() * m.orientation.toRotationMatrix());
  Mat3 tool = mean_rotation(tools);
  std::vector<double> deviation;
  for (int round = 0; round < 3; ++round) {  // mean of the better half: robust against wrong rows
    deviation.clear();
    for (const Mat3& t : tools) deviation.push_back(angle_between(tool, t));
    const double half = median(deviation);
    std::vector<Mat3> better;
    for (std::size_t i = 0; i < tools.size(); ++i)
      if (deviation[i] <= half) better.push_back(tools[i]);
    tool = mean_rotation(better);
  }
  return median(deviation);
}

template <class Change>
std::vector<OrientationMeasurement> transform_orientations(std::vector<OrientationMeasurement> all, Change change) {
  for (OrientationMeasurement& m : all) m.orientation = change(m.orientation).normalized();
  return all;
}

std::vector<OrientationInterpretation> quaternion_interpretations(const std::vector<OrientationMeasurement>& all) {
  const auto interpretation = [&](const char* name, auto change) {
    return OrientationInterpretation{{{"quaternions", std::string(name)}}, transform_orientations(all, change)};
  };
  return {interpretation("inverse", [](const Quat& q) { return q.conjugate(); }),
          interpretation("scalar_last", [](const Quat& q) { return Quat(q.z(), q.w(), q.x(), q.y()); }),
          interpretation("mirrored_x", [](const Quat& q) { return Quat(q.w(), q.x(), -q.y(), -q.z()); }),
          interpretation("mirrored_y", [](const Quat& q) { return Quat(q.w(), -q.x(), q.y(), -q.z()); }),
          interpretation("mirrored_z", [](const Quat& q) { return Quat(q.w(), -q.x(), -q.y(), q.z()); })};
}

}  // namespace

void check_orientations(DiagnosisState& state, const AlternativeOrientations& others) {
  PoseSet& data = state.task.data;
  if (data.orientations.size() < thresholds::min_orientations || data.points.empty()) return;
  const auto fit = fit_frames_quickly(state.task.nominal, thin_pose_set(data, thresholds::reference_rows));
  if (!fit || fit->median_error > max_plausible_error(state.task)) return;
  const PoseEvaluator evaluator(fit->chain, {});
  std::vector<Mat3> world_R_flange;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    world_R_flange.push_back(evaluator.pose(data.joints.col(row)).rotation);
  const double error_as_read = median_misalignment(world_R_flange, data.orientations);
  if (error_as_read <= thresholds::max_plausible_angle) return;

  std::vector<OrientationInterpretation> alternatives = others ? others() : std::vector<OrientationInterpretation>{};
  for (OrientationInterpretation& alternative : quaternion_interpretations(data.orientations))
    alternatives.push_back(std::move(alternative));
  const OrientationInterpretation* best = nullptr;
  double least = thresholds::orientation_improvement * error_as_read;
  for (const OrientationInterpretation& alternative : alternatives) {
    if (alternative.orientations.size() != data.orientations.size()) continue;
    const double deviation = median_misalignment(world_R_flange, alternative.orientations);
    if (deviation < least) least = deviation, best = &alternative;
  }
  const bool certain = best != nullptr && least <= thresholds::max_plausible_angle;
  FactValues values{{"disagreement_rad", error_as_read}};
  if (certain) {
    values.set("remaining_rad", least);
    for (const auto& [key, value] : best->convention) values.set(key, value);
  }
  add_finding(
      state,
      {.kind = FindingKind::orientation_convention, .severity = Severity::fault, .values = values, .applied = certain});
  if (certain) data.orientations = best->orientations;
}

}  // namespace kinfer::calibrate
