// Readings that bring the tool to a wanted place: damped Newton steps (Levenberg 1944, Marquardt 1963) inside the
// limits.
#pragma once

#include <string_view>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {

enum class Reach {
  reached,
  not_reachable,  ///< no small change of the readings brings the tool closer
  at_limit,       ///< the same, and a reading at its limit holds the tool back
  near_singular,  ///< steps spent where the machine has all but lost a direction of motion
  out_of_steps,   ///< steps spent elsewhere
};

/// One sentence for the user.
std::string_view sentence(Reach reach);

struct InverseOptions {
  double position_tolerance = 1e-9;  ///< [m]
  double angle_tolerance = 1e-9;     ///< [rad]
  int iterations = 200;              ///< Newton steps that may be tried, accepted or not
  double length = 1.0;               ///< [m] that weighs as much as 1 rad; about the reach of the machine
};

struct InverseSolution {
  VectorXd q;  ///< the best found, inside the limits, whatever the status says
  Reach reach = Reach::reached;
  double position_error = 0.0;  ///< [m] left
  double angle_error = 0.0;     ///< [rad] left; 0 where only a position was asked for
  int iterations = 0;
};

/// Readings near `start` that give the tool the pose world_T_tool. Of the many postures that may, the one that Newton's
/// steps reach from `start`: start from the nominal readings when compensating.
InverseSolution inverse(const Chain& chain, const Pose& world_T_tool, ConstVectorRef start,
                        const InverseOptions& options = {}, const Load& load = {});

/// The same for the tool point alone; its orientation is left free.
InverseSolution inverse_position(const Chain& chain, const Vec3& point, ConstVectorRef start,
                                 const InverseOptions& options = {}, const Load& load = {});

}  // namespace kinfer
