// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pairing/paired_set.hpp"

#include <algorithm>

#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {
namespace {

constexpr double slowest_stream = 0.5;  // [s] between rows; lists are slower

MatrixXd points_of(const PoseSet& measured) {
  MatrixXd points = MatrixXd::Zero(3, measured.rows());
  for (const PointMeasurement& point : measured.points)
    if (point.target < 0) points.col(point.row) = point.position;
  return points;
}

std::vector<Rest> rests_of(const PoseSet& set, const MatrixXd& values, const MatrixXd& keys) {
  const bool is_stream = set.time.size() > 2 && median_period(set.time) < slowest_stream;
  if (is_stream) return find_rests(set.time, values);
  std::vector<Rest> rests = rests_of_list(values, set.id, keys);
  if (set.time.empty()) return rests;
  for (Rest& rest : rests) {
    rest.begin = set.time[static_cast<std::size_t>(rest.first_row)];
    rest.end = set.time[static_cast<std::size_t>(rest.first_row + rest.rows - 1)];
  }
  return rests;
}

bool have_names(const std::vector<Rest>& rests) {
  return std::ranges::any_of(rests, [](const Rest& rest) { return !rest.name.empty(); });
}

/// Rests that last, as of a stream: pairing by time compares durations.
bool have_durations(const std::vector<Rest>& rests) {
  return !rests.empty() && std::ranges::all_of(rests, [](const Rest& rest) { return rest.end > rest.begin; });
}

/// Of the rows of one rest: the sum of the quaternions, all in one hemisphere.
std::optional<Quat> mean_orientation(const PoseSet& measured, const Rest& rest) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const OrientationMeasurement& m : measured.orientations) {
    if (m.row < rest.first_row || m.row >= rest.first_row + rest.rows) continue;
    const Eigen::Vector4d q = m.orientation.coeffs();
    sum += sum.dot(q) < 0.0 ? Eigen::Vector4d(-q) : q;
  }
  if (!(sum.norm() > 0.0)) return std::nullopt;
  Quat mean;
  mean.coeffs() = sum.normalized();
  return mean;
}

}  // namespace

std::vector<Rest> joint_rests(const PoseSet& joints) {
  return rests_of(joints, joints.joints, joints.joints);
}

std::vector<Rest> measured_rests(const PoseSet& measured) {
  return rests_of(measured, points_of(measured), MatrixXd());
}

Result<RestPairing> pair_rests(const RestLists& lists, std::optional<PairingMethod> method,
                               std::optional<double> offset) {
  const bool by_name = have_names(lists.joints) && have_names(lists.measured);
  const bool by_time = have_durations(lists.joints) && have_durations(lists.measured);
  if (method == PairingMethod::name && !by_name) return error("pairing by name needs a column id in both files");
  if (method == PairingMethod::time && !by_time)
    return error("pairing by time needs two streams with a column t, several rows a second");
  const PairingMethod used = method.value_or(by_name   ? PairingMethod::name
                                             : by_time ? PairingMethod::time
                                                       : PairingMethod::order);
  return used == PairingMethod::name   ? pair_by_name(lists)
         : used == PairingMethod::time ? pair_by_time(lists, offset)
                                       : pair_by_order(lists);
}

PoseSet paired_set(const PoseSet& joints, const PoseSet& measured, const RestLists& lists, const RestPairing& pairing) {
  PoseSet set;
  set.joint_names = joints.joint_names;
  set.joints.resize(joints.joints.rows(), static_cast<Eigen::Index>(pairing.pairs.size()));
  for (std::size_t i = 0; i < pairing.pairs.size(); ++i) {
    const auto row = static_cast<int>(i);
    const Rest &robot = lists.joints[static_cast<std::size_t>(pairing.pairs[i].joints)],
               &tracker = lists.measured[static_cast<std::size_t>(pairing.pairs[i].measured)];
    set.joints.col(row) = robot.mean;
    PointMeasurement point{.row = row, .position = tracker.mean.head<3>(), .sd = std::nullopt};
    if (tracker.scatter.head<3>().minCoeff() > 0.0) point.sd = Vec3(tracker.scatter.head<3>());
    set.points.push_back(point);
    if (const auto orientation = mean_orientation(measured, tracker))
      set.orientations.push_back({.row = row, .orientation = *orientation});
    const auto first = static_cast<std::size_t>(robot.first_row);
    if (!joints.id.empty()) set.id.push_back(joints.id[first]);
    set.line.push_back(joints.line[first]);
  }
  return set;
}

}  // namespace kinfer
