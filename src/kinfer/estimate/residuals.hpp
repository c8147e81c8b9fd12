// Weighted residuals of a chain on a pose set, with their analytic Jacobian: what every fit minimises.
//
// Measurements:      (measured − predicted) / sd, one block each (residual_<instrument>.cpp say what is compared).
// Socket distances:  (distance − |a − b|) / sd, plain rows.
// Priors:            prior_rows(set) · (x − nominal), plain rows, one a free parameter.
#pragma once

#include <vector>

#include "kinfer/estimate/pose_coupling.hpp"
#include "kinfer/estimate/residual_kind.hpp"
#include "kinfer/search/least_squares.hpp"

namespace kinfer {

enum class Derivative { no, yes };
/// Each row in its own mounting, with the loads of that row.
EvaluatedPoses evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative);
/// The same with torques of gravity that are known (empty: they are computed), into a buffer for the hot loop.
void evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative,
                    const MatrixXd& gravity, EvaluatedPoses& at);

/// Torque of gravity about each joint's axis at each row [N m], joints x rows; empty where nothing weighs anything.
MatrixXd torques_of_gravity(const Chain& chain, const PoseSet& data);

/// Payload, warming, torques and approach at one row of the set. Views into the set.
Load load_at(const Chain& chain, const PoseSet& data, Eigen::Index row);

/// What each measurement is worth: standard deviations, one a measurement of the pose set's lists.
struct Weights {
  std::vector<Vec3> point_sd;                                    ///< [m] per axis
  std::vector<Vec3> orientation_sd;                              ///< [rad] about the world's axes
  std::vector<Vec3> contact_sd, distance_sd, pair_sd, plane_sd;  ///< [m]; of one-row kinds only the first counts
  std::vector<Vec3> tilt_sd;                                     ///< [m/s²]; the first two count
  std::vector<PoseCoupling> couplings;  ///< of orientations with the points beside them, ascending; few sets have any

  std::vector<Vec3>& of(MeasurementKind kind);
  const std::vector<Vec3>& of(MeasurementKind kind) const;
};

/// The instrument's word, with a row's own standard deviation where the file gives it. A floor keeps noise-free data
/// finite.
Weights weights_of(const PoseSet& data, const Instrument& instrument);

/// One block of rows: which list and which entry it came from.
struct Block {
  MeasurementKind kind = MeasurementKind::point;
  int index = 0;  ///< into the pose set's list of that kind
  int row = 0;    ///< pose
  int size = 3;   ///< rows
};
std::vector<Block> blocks_of(const PoseSet& data);

/// The pose set without the measurements that are not kept, one entry a block of blocks_of.
PoseSet only(const PoseSet& data, const std::vector<bool>& kept);

/// The least-squares problem over the free parameters of `set`; blocks first (in the order of blocks_of), then the
/// socket distances, then the priors. All arguments must outlive the result.
Residuals pose_residuals(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights);

/// Rows of the socket distances from `row` on.
void write_socket_distances(const Chain& chain, const ColumnsOfSurroundings& columns, VectorXd& r, MatrixXd* jacobian,
                            Eigen::Index row);

/// Size of each measurement's residual, [m], [rad] or [m/s²], in the list's order.
std::vector<double> errors_of_kind(MeasurementKind kind, const Chain& chain, const PoseSet& data);

/// Euclidean error of each measured point [m] and angle of each measured orientation [rad], in the lists' order.
std::vector<double> point_errors(const Chain& chain, const PoseSet& data);
std::vector<double> orientation_errors(const Chain& chain, const PoseSet& data);

}  // namespace kinfer
