// What single-joint sweeps tell about base and tool: circles, their axes, and the frames built from them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The circle of one sweep and how well it is known, one sigma.
struct SweepCircle {
  std::string name;
  int reading = 0;  ///< index into q of the joint that was swept
  std::string joint;
  int rows = 0;
  double swept = 0.0;          ///< [rad] range of the joint
  Vec3 centre = Vec3::Zero();  ///< [m] in the world
  Vec3 axis = Vec3::UnitZ();   ///< unit, sense of the positive reading
  double radius = 0.0;         ///< [m]
  double rms = 0.0;            ///< [m] distance of the points from the circle
  double axis_sd = 0.0;        ///< [rad] in the worst direction
  double centre_sd = 0.0;      ///< [m] in the worst direction of the circle's plane
  double radius_sd = 0.0;      ///< [m]
  double off_by = 0.0;         ///< [m] distance of the chain's axis, in the frames found, from the circle's centre
  double turned_by = 0.0;      ///< [rad] angle between both axes
};

struct FramesFound {
  Chain chain;  ///< the nominal chain with the base and the tool found
  std::vector<SweepCircle> sweeps;
  std::string base_from;      ///< "joint J1 and joint J2"
  double tool_length = 0.0;   ///< [m] zt by the paper's radius (xt = yt = 0); the found tool's z where it has none
  std::string tool_from;      ///< "radius of the sweep of joint J5", or why there is none
  double base_differs = 0.0;  ///< [m] from the base that calibrate starts from, at the origin
  double base_turned = 0.0;   ///< [rad] likewise
  double tool_differs = 0.0;  ///< [m] from the tool that calibrate starts from
};

}  // namespace kinfer
