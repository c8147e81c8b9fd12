// SPDX-License-Identifier: Apache-2.0
// A chain in one form for every convention, as evidence.json stores it: enough to draw and animate the chain in twenty
// lines. parent_T_joint = before · (rotation about or translation along `axis` by the joint's variable) · after, where
// variable = gain · q[q_index] + sum of factor · q[k]. Compliance, harmonics and backlash are ignored.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// A pose as the file stores it.
struct ViewPose {
  Vec3 xyz = Vec3::Zero();                         ///< [m]
  std::array<double, 4> quat{1.0, 0.0, 0.0, 0.0};  ///< w x y z, unit

  Pose pose() const;
};
ViewPose view_pose(const Pose& pose);

struct JointView {
  std::string name{};
  int parent = -1;  ///< index of a joint before this one; -1: the base
  JointType type = JointType::fixed;
  int q_index = -1;  ///< into q; -1: none
  ViewPose before{};
  Vec3 axis = Vec3::Zero();  ///< unit, in the frame `before`; zero: does not move
  ViewPose after{};
  double gain = 1.0;
  std::vector<std::pair<int, double>> couplings{};  ///< index into q, factor
  std::optional<std::array<double, 2>> limits{};    ///< [rad] or [m]; none where a side is open
};

struct TargetView {
  std::string name{};
  Vec3 xyz = Vec3::Zero();  ///< [m] in the tool frame
};

struct ChainView {
  std::string name{};
  ViewPose base{};                  ///< world_T_base
  std::vector<JointView> joints{};  ///< parents before children
  int tip = -1;                     ///< joint that carries the tool; -1: the base
  ViewPose tool{};                  ///< tip_T_tool
  std::vector<TargetView> targets{};
  std::vector<std::string> joint_variables{};  ///< names of the elements of q
};

ChainView chain_view(const Chain& chain);

/// Every joint of the view in the world; `q`: joint positions [rad] or [m], missing ones count as 0.
struct JointViewPlacement {
  Pose frame;                 ///< world_T_joint after its motion
  Vec3 axis = Vec3::Zero();   ///< unit; zero for a fixed joint
  Vec3 point = Vec3::Zero();  ///< of the axis
};
std::vector<JointViewPlacement> place_joints(const ChainView& chain, const std::vector<double>& q);

/// world_T_tool, of joints that place_joints() placed.
Pose tool_pose(const ChainView& chain, const std::vector<JointViewPlacement>& joints);

}  // namespace kinfer
