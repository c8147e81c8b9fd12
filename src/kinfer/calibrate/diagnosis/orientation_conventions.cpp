// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/orientation_conventions.hpp"

#include <algorithm>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"

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
  return {{"inverted: they turn world coordinates into the tool's", "write the inverse rotations (qx, qy, qz negated)",
           transform_orientations(all, [](const Quat& q) { return q.conjugate(); })},
          {"in the order x, y, z, w", "rename the columns: qx, qy, qz, qw",
           transform_orientations(all, [](const Quat& q) { return Quat(q.z(), q.w(), q.x(), q.y()); })},
          {"left-handed: their axes are mirrored in x", "turn the signs of qy and qz",
           transform_orientations(all, [](const Quat& q) { return Quat(q.w(), q.x(), -q.y(), -q.z()); })},
          {"left-handed: their axes are mirrored in y", "turn the signs of qx and qz",
           transform_orientations(all, [](const Quat& q) { return Quat(q.w(), -q.x(), q.y(), -q.z()); })},
          {"left-handed: their axes are mirrored in z", "turn the signs of qx and qy",
           transform_orientations(all, [](const Quat& q) { return Quat(q.w(), -q.x(), -q.y(), q.z()); })}};
}

}  // namespace

void check_orientations(DiagnosisState& state, const AlternativeOrientations& others) {
  PoseSet& data = state.task.data;
  constexpr std::size_t too_few = 6;
  constexpr double max_plausible_angle = 3.0 * degree;
  if (data.orientations.size() < too_few || data.points.empty()) return;
  const auto fit = fit_frames_quickly(state.task.nominal, thin_pose_set(data, 80));
  if (!fit || fit->median_error > max_plausible_error(state.task)) return;
  const PoseEvaluator evaluator(fit->chain, {});
  std::vector<Mat3> world_R_flange;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    world_R_flange.push_back(evaluator.pose(data.joints.col(row)).rotation);
  const double error_as_read = median_misalignment(world_R_flange, data.orientations);
  if (error_as_read <= max_plausible_angle) return;

  std::vector<OrientationInterpretation> alternatives = others ? others() : std::vector<OrientationInterpretation>{};
  for (OrientationInterpretation& alternative : quaternion_interpretations(data.orientations))
    alternatives.push_back(std::move(alternative));
  const OrientationInterpretation* best = nullptr;
  double least = 0.2 * error_as_read;
  for (const OrientationInterpretation& alternative : alternatives) {
    if (alternative.orientations.size() != data.orientations.size()) continue;
    const double deviation = median_misalignment(world_R_flange, alternative.orientations);
    if (deviation < least) least = deviation, best = &alternative;
  }
  const bool certain = best != nullptr && least <= max_plausible_angle;
  add_finding(
      state,
      {.kind = FindingKind::orientation_convention,
       .severity = Severity::fault,
       .sentence = certain ? fmt::format("the orientations disagree with the joints by {:.0f} deg; they agree to "
                                         "{:.2f} deg when read {}",
                                         error_as_read / degree, least / degree, best->words)
                           : fmt::format("the orientations disagree with the joints by {:.0f} deg, and no other "
                                         "convention that was tried cures it",
                                         error_as_read / degree),
       .suggestion = certain ? best->suggestion : "check their order, sense and unit",
       .applied = certain});
  if (certain) data.orientations = best->orientations;
}

}  // namespace kinfer::calibrate
