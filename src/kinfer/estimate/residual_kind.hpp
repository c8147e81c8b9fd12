// One instrument, as the fit sees it: how many rows a measurement makes, what they are, and how they change with every
// unknown. A new instrument is a new file that defines one of these, and a line in residual_kinds().
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

enum class MeasurementKind { point, orientation, contact, distance, pair, plane, tilt };
inline constexpr int measurement_kinds = 7;

/// Poses and their derivatives at all rows of a pose set: evaluated once, read by every instrument.
struct EvaluatedPoses {
  std::vector<Pose> pose;      ///< one a row
  std::vector<Twists> twists;  ///< one a row, by the free parameters; empty when only residuals are wanted
};

/// Columns of the free parameters that are not part of the robot; −1: not free.
struct ColumnsOfSurroundings {
  using Three = std::array<Eigen::Index, 3>;
  std::vector<Three> target, anchor, socket;  ///< x y z
  std::vector<Three> plane;                   ///< rx ry offset
  Three gravity{-1, -1, -1};
  std::vector<Eigen::Index> base;  ///< all columns that place a base
};
ColumnsOfSurroundings columns_of_surroundings(const Chain& chain, const ParameterSet& set);

/// All that a residual is made from.
struct Scene {
  const Chain& chain;
  const PoseSet& data;
  const EvaluatedPoses& at;
  const ColumnsOfSurroundings& columns;

  int mounting(int row) const { return data.mounting.empty() ? -1 : data.mounting[row]; }
};

/// Where the rows of one block go; the Jacobian is null when only residuals are wanted.
struct BlockRows {
  VectorXd& residuals;
  MatrixXd* jacobian;
  Eigen::Index row = 0;
};

/// Residuals are measured − predicted, in m, rad or m/s²; dividing by the standard deviation is done by the caller.
struct ResidualKind {
  MeasurementKind kind;
  int size;                                                                   ///< rows of one block
  std::size_t (*count)(const PoseSet&);                                       ///< of blocks
  int (*row)(const PoseSet&, std::size_t index);                              ///< of the pose
  void (*keep)(PoseSet&, const std::vector<bool>& kept);                      ///< drops the others
  Vec3 (*promised_sd)(const PoseSet&, std::size_t index, const Instrument&);  ///< the first `size` count
  void (*write)(const Scene&, std::size_t index, BlockRows&);                 ///< one block
  std::string (*in_words)(double error);                                      ///< of one block's size
};

const ResidualKind& residual_kind(MeasurementKind kind);
/// In the order of the blocks.
std::span<const ResidualKind> residual_kinds();

/// One an instrument's file.
ResidualKind point_residual();
ResidualKind orientation_residual();
ResidualKind contact_residual();
ResidualKind distance_residual();
ResidualKind pair_residual();
ResidualKind plane_residual();
ResidualKind tilt_residual();

/// An error seen along the axes of its covariance, so that its parts are independent; none: as it is.
inline Vec3 along_axes(const std::optional<Mat3>& axes, const Vec3& error) {
  return axes ? Vec3(axes->transpose() * error) : error;
}

/// The entries of a list that are kept.
template <class T>
void keep_entries(std::vector<T>& list, const std::vector<bool>& kept) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < list.size(); ++from)
    if (kept[from]) list[to++] = list[from];
  list.resize(to);
}

}  // namespace kinfer
