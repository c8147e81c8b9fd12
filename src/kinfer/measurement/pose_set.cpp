// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pose_set.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

template <class T>
std::vector<T> pick(const std::vector<T>& from, const std::vector<int>& rows) {
  std::vector<T> picked;
  if (from.empty()) return picked;
  picked.reserve(rows.size());
  for (const int row : rows) picked.push_back(from[row]);
  return picked;
}

template <class T>
std::vector<T> pick_measurements(const std::vector<T>& from, const std::vector<std::vector<int>>& places) {
  std::vector<T> picked;
  for (const T& measurement : from)
    for (const int place : places[measurement.row]) {
      picked.push_back(measurement);
      picked.back().row = place;
    }
  return picked;
}

/// If both rows are listed twice, they form two pairs: the first copies, and the second ones.
std::vector<PairDistance> pick_pairs(const std::vector<PairDistance>& from,
                                     const std::vector<std::vector<int>>& places) {
  std::vector<PairDistance> picked;
  for (const PairDistance& pair : from) {
    const auto &rows = places[pair.row], &others = places[pair.other];
    for (std::size_t i = 0; i < std::min(rows.size(), others.size()); ++i)
      picked.push_back({rows[i], others[i], pair.distance});
  }
  return picked;
}

MatrixXd pick_columns(const MatrixXd& from, const std::vector<int>& rows) {
  return from.cols() == 0 ? from : MatrixXd(from(Eigen::all, rows));
}

}  // namespace

bool has_measurements(const PoseSet& set) {
  return !(set.points.empty() && set.orientations.empty() && set.distances.empty() && set.contacts.empty() &&
           set.pairs.empty() && set.plane_contacts.empty() && set.tilts.empty());
}

PoseSet select(const PoseSet& from, const std::vector<int>& rows) {
  std::vector<std::vector<int>> places(from.rows());  // new indices of each old row
  for (std::size_t i = 0; i < rows.size(); ++i) places[rows[i]].push_back(static_cast<int>(i));
  PoseSet set;
  set.joint_names = from.joint_names;
  set.joints = from.joints(Eigen::all, rows);
  set.commanded = pick_columns(from.commanded, rows);
  set.torques = pick_columns(from.torques, rows);
  set.approach = pick_columns(from.approach, rows);
  set.points = pick_measurements(from.points, places);
  set.orientations = pick_measurements(from.orientations, places);
  set.distances = pick_measurements(from.distances, places);
  set.contacts = pick_measurements(from.contacts, places);
  set.pairs = pick_pairs(from.pairs, places);
  set.plane_contacts = pick_measurements(from.plane_contacts, places);
  set.tilts = pick_measurements(from.tilts, places);
  set.targets = from.targets;
  set.sockets = from.sockets;
  set.planes = from.planes;
  set.setups = from.setups;
  set.sweeps = from.sweeps;
  set.tips = from.tips;
  set.setup = pick(from.setup, rows);
  set.sweep = pick(from.sweep, rows);
  set.tip = pick(from.tip, rows);
  set.mounting = pick(from.mounting, rows);
  set.payload = pick(from.payload, rows);
  set.temperature = pick(from.temperature, rows);
  set.id = pick(from.id, rows);
  set.set = pick(from.set, rows);
  set.line = pick(from.line, rows);
  return set;
}

PoseSet with_approach(PoseSet set) {
  constexpr double still = 1e-4;  // [rad] or [m]: below this a joint counts as at rest
  set.approach = MatrixXd::Zero(set.joints.rows(), set.joints.cols());
  for (Eigen::Index row = 1; row < set.rows(); ++row)
    for (Eigen::Index k = 0; k < set.joints.rows(); ++k) {
      const double step = set.joints(k, row) - set.joints(k, row - 1);
      if (std::abs(step) > still) set.approach(k, row) = step > 0.0 ? 1.0 : -1.0;
    }
  return set;
}

double position_sd(const Instrument& instrument, const Vec3& position) {
  return instrument.sigma + 1e-6 * instrument.ppm * position.norm();
}

PrincipalDeviations principal_deviations(const Mat3& covariance) {
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  return {eigen.values.cwiseMax(0.0).cwiseSqrt(), eigen.vectors};
}

Mat3 covariance_of(const Vec3& sd, const std::optional<Mat3>& axes) {
  const Mat3 along = sd.cwiseAbs2().asDiagonal();
  return axes ? Mat3(*axes * along * axes->transpose()) : along;
}

Mat3 correlation(const Vec3& point_sd, const std::optional<Mat3>& point_axes, const Vec3& turn_sd,
                 const OrientationMeasurement& orientation) {
  Mat3 y = *orientation.covariance_with_point;
  if (point_axes) y = (point_axes->transpose() * y).eval();
  if (orientation.axes) y = (y * *orientation.axes).eval();
  return point_sd.cwiseInverse().asDiagonal() * y * turn_sd.cwiseInverse().asDiagonal();
}

}  // namespace kinfer
