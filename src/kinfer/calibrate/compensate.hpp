// The point of it all: joint targets that put the real tool where the nominal model, or a target, wanted it.
//
// The corrected chain stands for the real robot. For each wanted tool pose its inverse kinematics is solved from the
// nominal readings, so that the robot keeps its posture.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/inverse.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// In which frames nominal and corrected tool are compared.
enum class CompensationFrames {
  as_given,  ///< each chain with its own base and tool: both files speak of the same world
  robot,     ///< the nominal base and tool for both: the corrected base tells where the instrument stood
};

/// `as_given`, unless the corrected base is further from the nominal one than three tolerances: then the instrument's
/// world is another one.
CompensationFrames believable_frames(const Chain& corrected, const Chain& nominal, const Tolerances& tolerances);

/// The corrected chain in the frames that are compared.
Chain in_frames(Chain corrected, const Chain& nominal, CompensationFrames frames);

struct Compensated {
  VectorXd q;                   ///< [rad] or [m]
  double residual = 0.0;        ///< [m] of the tool point, by the corrected chain
  double residual_angle = 0.0;  ///< [rad]
  Reach reach = Reach::reached;
};

/// For each column of `q` the readings at which `corrected` has its tool where `nominal` has it at q. A chain of fewer
/// than six joints cannot turn its tool freely: its tool point alone is put right.
std::vector<Compensated> compensate_joints(const Chain& corrected, const Chain& nominal, const MatrixXd& q,
                                           int threads);

/// A wanted tool point, with or without an orientation.
struct ToolTarget {
  Vec3 position = Vec3::Zero();
  std::optional<Mat3> rotation;
};

/// Readings that bring the tool of `corrected` to each target. They start from the nominal solution, which itself
/// starts from `start` (dof x targets) where given, else from several postures inside the limits.
std::vector<Compensated> compensate_targets(const Chain& corrected, const Chain& nominal,
                                            const std::vector<ToolTarget>& targets, const MatrixXd& start, int threads,
                                            Rng rng);

}  // namespace kinfer
