// A pose set of a robot with known errors, measured by a tracker with known noise.
#pragma once

#include <limits>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Where poses are drawn: uniform within the joint limits (±170° or 0 .. 0.3 m where a joint has none), in free space.
struct PoseSpace {
  double lowest = -std::numeric_limits<double>::infinity();  ///< [m] tool above this height over the base
  double clearance = 0.0;                                    ///< [m] tool further than this from the base's z axis
};

enum class Measured { positions, poses };

struct PoseSimulation {
  int poses = 50;
  PoseSpace space{};
  Instrument instrument{.sigma = 10e-6, .sigma_angle = 1e-5, .ppm = 5.0};
  Measured measured = Measured::positions;
  /// [rad] the instrument's stand turns by this much about each axis between poses, position and orientation with it;
  /// the poses come with the covariance of all six. 0: it stands still.
  double shake = 0.0;
};

/// `nominal` with every parameter's error drawn from its tolerance (Gaussian); base and tool included.
Chain with_random_errors(const Chain& nominal, const Tolerances& tolerances, Rng rng);

/// The tool of `truth` at these joints (readings x rows), as the instrument sees it; one without sigma and ppm does not
/// err.
PoseSet seen_points(const Chain& truth, const MatrixXd& joints, const Instrument& instrument = {}, Rng rng = Rng(1));

/// An error where the space leaves hardly any pose.
Result<PoseSet> simulate_pose_set(const Chain& truth, const PoseSimulation& simulation, Rng rng);

}  // namespace kinfer
