// SPDX-License-Identifier: Apache-2.0
// The joints of a URDF text and where their origins are in it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/io/text/xml_positions.hpp"

namespace kinfer {

struct UrdfJointPosition {
  std::string name, parent_link, child_link;
  bool is_fixed = false;
  int line = 0;  ///< of <joint>, from 1
  Vec3 xyz = Vec3::Zero(), rpy = Vec3::Zero();
  std::optional<XmlElementPosition> origin{};  ///< none: the file has none, which means the identity
  XmlElementPosition first_child{};            ///< of the joint

  Pose pose() const { return {from_rpy(rpy), xyz}; }
};

struct UrdfJointPositions {
  std::string robot_name;
  std::vector<UrdfJointPosition> joints;  ///< in the order of the file

  const UrdfJointPosition* find(std::string_view joint) const;     ///< null where there is none
  const UrdfJointPosition* joint_to(std::string_view link) const;  ///< null where the link is the root
};

/// The joints of <robot>: not those that <transmission>, <gazebo> or <ros2_control> name. An error where the places
/// found in the text and the tree that tinyxml2 reads from it disagree.
Result<UrdfJointPositions> locate_urdf_joints(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
