// Poses that a robot may take while an instrument looks at it.
#pragma once

#include <limits>
#include <optional>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct MeasuringSpace {
  double lowest = -std::numeric_limits<double>::infinity();  ///< [m] height over the base that tool and joints keep
  double clearance = 0.0;                                    ///< [m] tool further than this from the base's z axis
  std::optional<Vec3> instrument{};                          ///< [m] in the world
  Vec3 target_faces = Vec3::UnitZ();                         ///< direction that the target looks, in the tool's frame
  double acceptance = 60.0 * 3.14159265358979323846 / 180;   ///< [rad] half angle within which the target is seen
};

/// Smallest and largest reading of joint k of the joints with a reading: its limits, else ±170° or 0 .. 0.3 m,
/// less a hundredth at each end.
struct ReadingRange {
  double low = 0.0, high = 0.0;
};
ReadingRange reading_range(const Joint& joint);

/// Whether limits, floor, clearance and view allow the pose.
bool in_space(const Chain& chain, ConstVectorRef q, const MeasuringSpace& space);

/// A pose near `q` in the space: one to all joints moved a little or far, kept inside their ranges; empty where several
/// tries fail.
VectorXd pose_near(const Chain& chain, const MeasuringSpace& space, ConstVectorRef q, Rng& rng);

/// `count` poses drawn evenly from the joint ranges that keep to the space, dof x count. An error where hardly any do.
Result<MatrixXd> draw_poses(const Chain& chain, const MeasuringSpace& space, int count, Rng rng);

/// Order of the columns that moves the joints least, from the one nearest to the middle of the ranges on: nearest
/// neighbours, then 2-opt exchanges. The way between two poses is the largest motion of a joint [rad] (1 m = 1 rad).
std::vector<int> order_of_least_travel(const Chain& chain, const MatrixXd& q);
double travel(const MatrixXd& q, const std::vector<int>& order);

}  // namespace kinfer
