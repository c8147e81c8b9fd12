// SPDX-License-Identifier: Apache-2.0
// Base and tool frames from single-joint sweeps: the fitted circles, their axes, and the frames built from them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The fitted circle of one sweep with its standard deviations.
struct SweepCircle {
  std::string name;                 ///< as marked in the file; empty: found by its rows
  int first_row = 0, last_row = 0;  ///< from 0
  int q_index = 0;                  ///< index of the swept joint in q
  std::string joint{};
  int rows = 0;
  double swept = 0.0;          ///< [rad] range of the joint
  Vec3 centre = Vec3::Zero();  ///< [m] in the world frame
  Vec3 axis = Vec3::UnitZ();   ///< unit, in the world frame; positive joint motion is right-handed about it
  double radius = 0.0;         ///< [m]
  double rms = 0.0;            ///< [m] distance between the points and the circle
  double axis_sd = 0.0;        ///< [rad] in the worst direction
  double centre_sd = 0.0;      ///< [m] in the worst direction of the circle's plane
  double radius_sd = 0.0;      ///< [m]
  double off_by = 0.0;         ///< [m] distance from the circle's centre to the axis of `FrameEstimate::chain`
  double axis_angle = 0.0;     ///< [rad] angle between the two axes
};

/// How the tool length was found.
enum class ToolLengthSource {
  mean_tool_point,     ///< there is no sweep of the last joint but one
  sweep_radius,        ///< from the radius of the sweep of the last joint but one
  radius_without_fit,  ///< that radius does not fit a tool on the flange's axis: the mean tool point is used
};
std::string_view name(ToolLengthSource source);

struct FrameEstimate {
  Chain chain;  ///< the nominal chain with the estimated base and tool
  std::vector<SweepCircle> sweeps;
  std::array<std::string, 2> base_joints;  ///< the joints whose axes give the base
  double tool_length = 0.0;  ///< [m] zt from the paper's radius (xt = yt = 0), else z of the estimated tool
  ToolLengthSource tool_length_source = ToolLengthSource::mean_tool_point;
  std::string tool_joint;     ///< whose sweep gives the radius; empty: none
  double base_differs = 0.0;  ///< [m] distance from the initial base of calibrate, at the origin
  double base_turned = 0.0;   ///< [rad] rotation from the initial base of calibrate
  double tool_differs = 0.0;  ///< [m] distance from the initial tool of calibrate
};

}  // namespace kinfer
