// SPDX-License-Identifier: Apache-2.0
// The bodies, joints, sites and joint constraints of an MJCF file, with defaults and units resolved, each with its
// place in the file. What MuJoCo's XML reference calls a default or an inherited attribute is looked up here and
// nowhere else.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/io/robot/mjcf/mjcf_orientation.hpp"

namespace kinfer {

enum class MjcfJointType { hinge, slide, ball, free };

struct MjcfJoint {
  std::string name;  ///< where the file gives none, that of the body and a number
  int body = 0;
  MjcfJointType type = MjcfJointType::hinge;
  Pose frame;                       ///< body_T_frame: of the <frame> elements around it
  Vec3 position = Vec3::Zero();     ///< [m] in the body
  Vec3 axis = Vec3::UnitZ();        ///< unit, in the body
  double reference = 0.0;           ///< [rad] or [m] joint position at which the body has the pose of the file
  double lower = 0.0, upper = 0.0;  ///< [rad] or [m]
  bool is_limited = false;
  int line = 0, element = 0;  ///< element: its number in the file, from 0
};

struct MjcfBody {
  std::string name;  ///< where the file gives none, "body" and a number
  int parent = -1;   ///< −1: the world
  Pose frame;        ///< parent_T_frame: of the <frame> elements around it
  Pose local;        ///< frame_T_body, as the body's attributes give it
  MjcfOrientation orientation = MjcfOrientation::none;
  std::vector<double> orientation_numbers{};
  std::vector<int> joints{};  ///< in the order in which they move the body
  bool is_leaf = true;
  int line = 0, element = 0;

  Pose pose() const { return frame * local; }  ///< parent_T_body at the joints' references
};

struct MjcfSite {
  std::string name;
  int body = -1;
  Pose pose;                       ///< body_T_site
  bool is_placed_by_ends = false;  ///< by fromto: its pose is unknown here
};

/// <equality><joint>: q − reference = polycoef of the other joint's (q − reference), in rad and m.
struct MjcfJointConstraint {
  std::string joint, other;  ///< other empty: the joint does not move
  std::array<double, 5> polynomial{0.0, 1.0, 0.0, 0.0, 0.0};
  int line = 0;
};

struct MjcfTree {
  std::string model;
  MjcfUnits units;
  std::vector<MjcfBody> bodies;  ///< parents before children, in the order of the file
  std::vector<MjcfJoint> joints;
  std::vector<MjcfSite> sites;
  std::vector<MjcfJointConstraint> constraints;  ///< active ones

  int body_named(std::string_view name) const;  ///< −1 where there is none
  int joint_named(std::string_view name) const;
  const MjcfSite* site_named(std::string_view name) const;  ///< null where there is none
};

/// Errors: malformed XML, <include>, <replicate>, <attach>, global coordinates, unknown classes, names that appear
/// twice, numbers that are none, are not finite or have no direction.
Result<MjcfTree> parse_mjcf_tree(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
