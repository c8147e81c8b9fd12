// SPDX-License-Identifier: Apache-2.0
// Simulated pose sets of a robot with known errors, measured by a tracker with known noise.
#pragma once

#include <limits>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Where poses are drawn: uniform within the joint limits (±170° or 0 .. 0.3 m where a joint has none), in free space.
struct PoseSpace {
  double lowest = -std::numeric_limits<double>::infinity();  ///< [m] minimum height of the tool over the base
  double clearance = 0.0;  ///< [m] minimum distance of the tool from the base's z axis
};

enum class Measured { positions, poses };

struct PoseSimulation {
  int poses = 50;
  PoseSpace space{};
  Instrument instrument{.sigma = 10e-6, .sigma_angle = 1e-5, .ppm = 5.0};
  Measured measured = Measured::positions;
  /// [rad] sd of the rotation of the instrument's stand about each axis, drawn for each pose and common to position and
  /// orientation; the poses then carry the covariance of all six. 0: the stand is fixed.
  double shake = 0.0;
};

/// `nominal` with every parameter's error drawn from its tolerance (Gaussian); base and tool included.
Chain with_random_errors(const Chain& nominal, const Tolerances& tolerances, Rng rng);

/// Tool positions of `truth` at these joint positions (dof x rows) as the instrument measures them; without sigma and
/// ppm there is no noise.
PoseSet simulate_points(const Chain& truth, const MatrixXd& joints, const Instrument& instrument = {},
                        Rng rng = Rng(1));

/// An error if hardly any random pose lies in the space.
Result<PoseSet> simulate_pose_set(const Chain& truth, const PoseSimulation& simulation, Rng rng);

}  // namespace kinfer
