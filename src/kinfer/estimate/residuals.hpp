// Weighted residuals of a chain on a pose set, with their analytic Jacobian: what every fit minimises.
//
// Point:        (p_measured − p_predicted) / sd, one block of three.
// Orientation:  log(R_measured R_predictedᵀ) / sigma_angle, one block of three (rotation vector in the world).
// Prior:        (x − nominal) / prior_sd, plain rows.
#pragma once

#include <vector>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/search/least_squares.hpp"

namespace kinfer {

/// Poses and their derivatives at all rows of a pose set: evaluated once, read by every instrument.
struct EvaluatedPoses {
  std::vector<Pose> pose;      ///< one a row
  std::vector<Twists> twists;  ///< one a row, by the free parameters; empty when only residuals are wanted
};
enum class Derivative { no, yes };
EvaluatedPoses evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative);

/// What each measurement is worth: standard deviations, one a measurement of the pose set's lists.
struct Weights {
  std::vector<Vec3> point_sd;          ///< [m] per axis
  std::vector<double> orientation_sd;  ///< [rad]
};

/// The instrument's word, with a row's own standard deviation where the file gives it. `floor` keeps noise-free data
/// finite.
Weights weights_of(const PoseSet& data, const Instrument& instrument);

/// One block of rows: which list and which entry it came from.
enum class MeasurementKind { point, orientation };
struct Block {
  MeasurementKind kind = MeasurementKind::point;
  int index = 0;  ///< into the pose set's list of that kind
  int row = 0;    ///< pose
};
std::vector<Block> blocks_of(const PoseSet& data);

/// The least-squares problem over the free parameters of `set`; blocks first (in the order of blocks_of), then the
/// priors. All arguments must outlive the result.
Residuals pose_residuals(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights);

/// Euclidean error of each measured point [m] and angle of each measured orientation [rad], in the lists' order.
std::vector<double> point_errors(const Chain& chain, const PoseSet& data);
std::vector<double> orientation_errors(const Chain& chain, const PoseSet& data);

}  // namespace kinfer
