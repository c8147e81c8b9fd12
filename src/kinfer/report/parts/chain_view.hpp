// SPDX-License-Identifier: Apache-2.0
// A chain as stored in evidence.json, and its forward kinematics.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/joint_type.hpp"

namespace kinfer {

struct JointView {
  std::string name;
  int parent = -1;
  JointType type = JointType::fixed;
  int reading = -1;
  Pose before, after;
  Vec3 axis = Vec3::Zero();
  double gain = 1.0;
  std::vector<std::pair<int, double>> couplings;
};

struct ChainView {
  Pose base, tool;
  int tip = -1;
  std::vector<JointView> joints;
};

struct JointPlacementView {
  Pose frame;                 ///< world_T_joint after its motion
  Vec3 axis = Vec3::Zero();   ///< in the world, unit; zero for a fixed joint
  Vec3 point = Vec3::Zero();  ///< of the axis
};

ChainView chain_view(const nlohmann::json& chain);

/// `q`: joint positions [rad] or [m]; missing ones count as 0.
std::vector<JointPlacementView> placed(const ChainView& chain, const std::vector<double>& q);
Pose tool_pose(const ChainView& chain, const std::vector<JointPlacementView>& joints);

}  // namespace kinfer
