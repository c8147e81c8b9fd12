// SPDX-License-Identifier: Apache-2.0
// Residual model of one kind of measurement: number of rows, residual and Jacobian. A new kind is a new file that
// defines one of these, and a line in residual_kinds().
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/evidence/measurement_kind.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Poses and their derivatives at all rows of a pose set: evaluated once for all kinds of measurements.
struct EvaluatedPoses {
  std::vector<Pose> pose;      ///< one per row
  std::vector<Twists> twists;  ///< one per row, by the free parameters; empty for residuals only
};

/// Jacobian columns of the free parameters outside the robot (fixtures, gravity); −1: not free.
struct FixtureColumns {
  using Xyz = std::array<Eigen::Index, 3>;
  std::vector<Xyz> target, anchor, socket;  ///< x y z
  std::vector<Xyz> plane;                   ///< rx ry offset
  Xyz gravity{-1, -1, -1};
  std::vector<Eigen::Index> base;  ///< columns of all base frames
};
FixtureColumns fixture_columns(const Chain& chain, const ParameterSet& set);

/// Input of a residual.
struct ResidualContext {
  const Chain& chain;
  const PoseSet& data;
  const EvaluatedPoses& at;
  const FixtureColumns& columns;

  int mounting(int row) const { return data.mounting.empty() ? -1 : data.mounting[row]; }
};

/// Destination of one block's rows; the Jacobian is null for residuals only.
struct BlockRows {
  VectorXd& residuals;
  MatrixXd* jacobian;
  Eigen::Index row = 0;
};

/// Residuals are measured − predicted, in m, rad or m/s²; the caller divides by the standard deviation.
struct ResidualKind {
  MeasurementKind kind;
  int size;                                                                    ///< rows of one block
  std::size_t (*count)(const PoseSet&);                                        ///< number of blocks
  int (*row)(const PoseSet&, std::size_t index);                               ///< row of the pose
  void (*keep)(PoseSet&, const std::vector<bool>& kept);                       ///< removes the others
  Vec3 (*specified_sd)(const PoseSet&, std::size_t index, const Instrument&);  ///< the first `size` are used
  void (*write)(const ResidualContext&, std::size_t index, BlockRows&);        ///< residual and Jacobian of one block
};

const ResidualKind& residual_kind(MeasurementKind kind);
/// All kinds, in the order of the blocks.
std::span<const ResidualKind> residual_kinds();

/// Each defined in its own file.
ResidualKind point_residual();
ResidualKind orientation_residual();
ResidualKind contact_residual();
ResidualKind distance_residual();
ResidualKind pair_residual();
ResidualKind plane_residual();
ResidualKind tilt_residual();

/// An error in the principal axes of its covariance, so that its components are independent; without axes: unchanged.
inline Vec3 along_axes(const std::optional<Mat3>& axes, const Vec3& error) {
  return axes ? Vec3(axes->transpose() * error) : error;
}

/// Removes the entries of a list that are not kept.
template <class T>
void keep_entries(std::vector<T>& list, const std::vector<bool>& kept) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < list.size(); ++from)
    if (kept[from]) list[to++] = list[from];
  list.resize(to);
}

}  // namespace kinfer
