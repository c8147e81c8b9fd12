// A chain as evidence.json tells it, and where its frames are.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinfer/geometry/pose.hpp"

namespace kinfer {

struct JointView {
  std::string name;
  int parent = -1;
  std::string type;  ///< "revolute", "prismatic", "fixed"
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

struct PlacedView {
  Pose frame;                 ///< world_T_joint after its motion
  Vec3 axis = Vec3::Zero();   ///< in the world, unit; zero: does not move
  Vec3 point = Vec3::Zero();  ///< of the axis
};

ChainView chain_view(const nlohmann::json& chain);

/// `q`: readings [rad] or [m]; missing ones count as 0.
std::vector<PlacedView> placed(const ChainView& chain, const std::vector<double>& q);
Pose tool_pose(const ChainView& chain, const std::vector<PlacedView>& joints);

}  // namespace kinfer
