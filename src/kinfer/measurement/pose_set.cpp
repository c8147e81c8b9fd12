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

RecordedJoints select(const RecordedJoints& from, const std::vector<int>& rows) {
  return {from.joint_names, from.joints(Eigen::all, rows), pick_columns(from.commanded, rows)};
}

RowConditions select(const RowConditions& from, const std::vector<int>& rows) {
  return {pick_columns(from.torques, rows), pick_columns(from.approach, rows), pick(from.payload, rows),
          pick(from.temperature, rows)};
}

PoseMeasurements select(const PoseMeasurements& from, const std::vector<std::vector<int>>& places) {
  PoseMeasurements picked;
  for_each_list(from, [&]<class M>(const std::vector<M>& list) {
    if constexpr (std::is_same_v<M, PairDistance>)
      picked.pairs = pick_pairs(list, places);
    else
      list_of<M>(picked) = pick_measurements(list, places);
  });
  return picked;
}

RowGroups select(const RowGroups& from, const std::vector<int>& rows) {
  return {.setups = from.setups,
          .sweeps = from.sweeps,
          .tips = from.tips,
          .setup = pick(from.setup, rows),
          .tip = pick(from.tip, rows),
          .sweep = pick(from.sweep, rows),
          .mounting = pick(from.mounting, rows),
          .pose = pick(from.pose, rows)};
}

RowOrigin select(const RowOrigin& from, const std::vector<int>& rows) {
  return {pick(from.id, rows), pick(from.set, rows), pick(from.line, rows), pick(from.time, rows)};
}

}  // namespace

bool has_measurements(const PoseMeasurements& measured) {
  bool any = false;
  for_each_list(measured, [&](const auto& list) { any |= !list.empty(); });
  return any;
}

std::vector<Vec3> point_positions(const PoseMeasurements& measured) {
  std::vector<Vec3> positions;
  for (const PointMeasurement& point : measured.points) positions.push_back(point.position);
  return positions;
}

PoseSet select(const PoseSet& from, const std::vector<int>& rows) {
  std::vector<std::vector<int>> places(from.rows());  // new indices of each old row
  for (std::size_t i = 0; i < rows.size(); ++i) places[rows[i]].push_back(static_cast<int>(i));
  return {
      select(static_cast<const RecordedJoints&>(from), rows),     select(static_cast<const RowConditions&>(from), rows),
      select(static_cast<const PoseMeasurements&>(from), places), static_cast<const FixtureNames&>(from),
      select(static_cast<const RowGroups&>(from), rows),          select(static_cast<const RowOrigin&>(from), rows)};
}

PoseSet with_approach(PoseSet set) {
  constexpr double still = 1e-4;  // of the range
  set.approach = MatrixXd::Zero(set.joints.rows(), set.joints.cols());
  if (set.rows() == 0) return set;
  const VectorXd scatter = still * (set.joints.rowwise().maxCoeff() - set.joints.rowwise().minCoeff());
  VectorXd farthest = set.joints.col(0);  // in the sense of the last movement
  for (Eigen::Index row = 1; row < set.rows(); ++row) {
    set.approach.col(row) = set.approach.col(row - 1);
    const auto here = static_cast<std::size_t>(row);
    if (!set.pose.empty() && set.pose[here] == set.pose[here - 1]) continue;
    for (Eigen::Index k = 0; k < set.joints.rows(); ++k) {
      const double step = set.joints(k, row) - farthest[k], sense = step > 0.0 ? 1.0 : -1.0;
      if (std::abs(step) <= scatter[k] && sense != set.approach(k, row)) continue;
      if (step != 0.0) set.approach(k, row) = sense, farthest[k] = set.joints(k, row);
    }
  }
  return set;
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
