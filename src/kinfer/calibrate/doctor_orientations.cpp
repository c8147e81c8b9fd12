#include "kinfer/calibrate/doctor_orientations.hpp"

#include <algorithm>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// Median angle [rad] between measured and predicted orientations, the tool turned to fit best.
double misfit(const std::vector<Mat3>& world_R_flange, const std::vector<OrientationMeasurement>& measured) {
  std::vector<Mat3> tools;
  for (const OrientationMeasurement& m : measured)
    tools.push_back(world_R_flange[m.row].transpose() * m.orientation.toRotationMatrix());
  Mat3 tool = mean_rotation(tools);
  std::vector<double> off;
  for (int round = 0; round < 3; ++round) {  // the mean of the better half: wrong rows must not pull
    off.clear();
    for (const Mat3& t : tools) off.push_back(angle_between(tool, t));
    const double half = median(off);
    std::vector<Mat3> better;
    for (std::size_t i = 0; i < tools.size(); ++i)
      if (off[i] <= half) better.push_back(tools[i]);
    tool = mean_rotation(better);
  }
  return median(off);
}

template <class Change>
std::vector<OrientationMeasurement> changed(std::vector<OrientationMeasurement> all, Change change) {
  for (OrientationMeasurement& m : all) m.orientation = change(m.orientation).normalized();
  return all;
}

std::vector<OrientationReading> quaternion_readings(const std::vector<OrientationMeasurement>& all) {
  return {{"inverted: they turn world coordinates into the tool's", "write the inverse rotations (qx, qy, qz negated)",
           changed(all, [](const Quat& q) { return q.conjugate(); })},
          {"in the order x, y, z, w", "rename the columns: qx, qy, qz, qw",
           changed(all, [](const Quat& q) { return Quat(q.z(), q.w(), q.x(), q.y()); })},
          {"left-handed: their axes are mirrored in x", "turn the signs of qy and qz",
           changed(all, [](const Quat& q) { return Quat(q.w(), q.x(), -q.y(), -q.z()); })},
          {"left-handed: their axes are mirrored in y", "turn the signs of qx and qz",
           changed(all, [](const Quat& q) { return Quat(q.w(), -q.x(), q.y(), -q.z()); })},
          {"left-handed: their axes are mirrored in z", "turn the signs of qx and qy",
           changed(all, [](const Quat& q) { return Quat(q.w(), -q.x(), -q.y(), q.z()); })}};
}

}  // namespace

void check_orientations(DoctorCase& patient, const OtherReadings& others) {
  PoseSet& data = patient.task.data;
  constexpr std::size_t too_few = 6;
  constexpr double believable = 3.0 * degree;
  if (data.orientations.size() < too_few || data.points.empty()) return;
  const auto fit = quick_fit(patient.task.nominal, thinned_points(data, 80));
  if (!fit || fit->typical > believable_error(patient.task)) return;
  const PoseEvaluator evaluator(fit->chain, {});
  std::vector<Mat3> world_R_flange;
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    world_R_flange.push_back(evaluator.pose(data.joints.col(row)).rotation);
  const double as_read = misfit(world_R_flange, data.orientations);
  if (as_read <= believable) return;

  std::vector<OrientationReading> readings = others ? others() : std::vector<OrientationReading>{};
  for (OrientationReading& reading : quaternion_readings(data.orientations)) readings.push_back(std::move(reading));
  const OrientationReading* best = nullptr;
  double least = 0.2 * as_read;
  for (const OrientationReading& reading : readings) {
    if (reading.orientations.size() != data.orientations.size()) continue;
    const double off = misfit(world_R_flange, reading.orientations);
    if (off < least) least = off, best = &reading;
  }
  const bool certain = best != nullptr && least <= believable;
  add_finding(
      patient,
      {.kind = "orientation_convention",
       .severity = Severity::fault,
       .sentence = certain ? fmt::format("the orientations disagree with the joints by {:.0f} deg; they agree to "
                                         "{:.2f} deg when read {}",
                                         as_read / degree, least / degree, best->words)
                           : fmt::format("the orientations disagree with the joints by {:.0f} deg, and no other "
                                         "convention that was tried cures it",
                                         as_read / degree),
       .suggestion = certain ? best->suggestion : "check their order, sense and unit",
       .applied = certain});
  if (certain) data.orientations = best->orientations;
}

}  // namespace kinfer
