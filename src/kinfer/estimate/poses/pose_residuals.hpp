// SPDX-License-Identifier: Apache-2.0
// Weighted residuals of a chain on a pose set, with their analytic Jacobian: the objective of every fit to poses.
//
// Measurements:      (measured − predicted) / sd, one block each (defined in instruments/).
// Socket distances:  (distance − |a − b|) / sd, plain rows.
// Priors:            prior_sqrt_information_of(set) · (x − nominal), plain rows, one per free parameter.
#pragma once

#include <vector>

#include "kinfer/estimate/poses/pose_weights.hpp"
#include "kinfer/search/least_squares/least_squares.hpp"

namespace kinfer {

enum class Derivative { no, yes };
/// Each row in its own mounting, with the loads of that row; on up to `threads` threads.
EvaluatedPoses evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative,
                              int threads = 1);
/// The same with given gravity torques (empty: they are computed), into a reused buffer for the inner loop.
void evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative,
                    const MatrixXd& gravity, EvaluatedPoses& at, int threads = 1);

/// Gravity torque about each joint's axis at each row [N m], joints x rows; empty without masses and payload.
MatrixXd gravity_torques_of_rows(const Chain& chain, const PoseSet& data, int threads = 1);

/// Payload, temperature rise, torques and approach direction at one row of the set. Views into the set.
Load load_at(const Chain& chain, const PoseSet& data, Eigen::Index row);

/// The least-squares problem over the free parameters of `set`; blocks first (in the order of blocks_of), then the
/// socket distances, then the priors. All arguments must outlive the result. Poses on up to `threads` threads.
Residuals pose_residuals(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                         int threads = 1);

/// (measured − predicted) / sd of all blocks at poses that are known, without socket distances and priors.
VectorXd weighted_residuals(const ResidualContext& scene, const Weights& weights);

/// Rows of the socket distances from `row` on.
void write_socket_distances(const Chain& chain, const FixtureColumns& columns, VectorXd& r, MatrixXd* jacobian,
                            Eigen::Index row);

/// Norm of each measurement's residual, [m], [rad] or [m/s²], in the list's order.
std::vector<double> residual_norms(MeasurementKind kind, const Chain& chain, const PoseSet& data);

/// The same in metres at the tool point, for kinds whose residual is another quantity.
std::vector<double> position_errors(MeasurementKind kind, const Chain& chain, const PoseSet& data);

/// Euclidean error of each measured point [m] and angle of each measured orientation [rad], in the lists' order.
std::vector<double> point_errors(const Chain& chain, const PoseSet& data);
std::vector<double> orientation_errors(const Chain& chain, const PoseSet& data);

}  // namespace kinfer
