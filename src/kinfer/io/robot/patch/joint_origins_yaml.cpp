// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/joint_origins_yaml.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "kinfer/io/text/format_number.hpp"
#include "kinfer/io/text/quoted_text.hpp"

namespace kinfer {
namespace {

/// A YAML key: quoted where it is not a plain word.
std::string yaml_key(const std::string& name) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  const bool is_plain = !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) &&
                        name.find_first_not_of(plain) == std::string::npos;
  if (is_plain) return name;
  return quoted_text(name);
}

std::string six_numbers(const UrdfJointPosition& joint, std::string_view indent) {
  constexpr const char *lengths[] = {"x", "y", "z"}, *angles[] = {"roll", "pitch", "yaw"};
  std::string text;
  for (int k = 0; k < 3; ++k) text += fmt::format("{}{}: {}\n", indent, lengths[k], format_number(joint.xyz[k] + 0.0));
  for (int k = 0; k < 3; ++k) text += fmt::format("{}{}: {}\n", indent, angles[k], format_number(joint.rpy[k] + 0.0));
  return text;
}

/// The joint whose child link has the name, whatever stands before it: "left_shoulder_link" for "shoulder".
const UrdfJointPosition* joint_to_link_ending(const UrdfJointPositions& joints, const std::string& ending) {
  for (const UrdfJointPosition& joint : joints.joints)
    if (!joint.is_fixed && joint.child_link.ends_with(ending)) return &joint;
  return nullptr;
}

std::optional<std::string> universal_robots(const UrdfJointPositions& joints) {
  std::string text =
      "# Load as kinematics_params of ur_description. The driver compares the hash with the robot's own and warns "
      "where\n"
      "# they differ: put the hash of the robot's factory calibration here.\nkinematics:\n";
  for (const char* part : {"shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"}) {
    const UrdfJointPosition* joint = joint_to_link_ending(joints, std::string(part) + "_link");
    if (!joint) return std::nullopt;
    text += fmt::format("  {}:\n{}", part, six_numbers(*joint, "    "));
  }
  return text + "  hash: calib_kinfer\n";
}

/// "joint1" of "fr3_joint1" and "left_fr3_joint1"; empty for other names.
std::string franka_key(const UrdfJointPosition& joint) {
  const std::size_t at = joint.name.rfind("joint");
  if (at == std::string::npos || joint.name.size() != at + 6) return "";
  const std::string_view prefix = std::string_view(joint.name).substr(0, at);
  bool is_franka = false;
  for (const std::string_view type : {"panda_", "fr3_", "fer_", "fp3_", "fr3v2_"}) is_franka |= prefix.ends_with(type);
  const char digit = joint.name.back();
  return is_franka && digit >= '1' && digit <= '8' ? joint.name.substr(at) : "";
}

std::optional<std::string> franka(const UrdfJointPositions& joints) {
  std::string text = "# Load in place of kinematics.yaml of franka_description.\n";
  int moving = 0;
  for (const UrdfJointPosition& joint : joints.joints) {
    const std::string key = franka_key(joint);
    if (key.empty()) continue;
    moving += joint.is_fixed ? 0 : 1;
    text += fmt::format("\n{}:\n  kinematic:\n{}", key, six_numbers(joint, "    "));
  }
  return moving == 7 ? std::optional(text) : std::nullopt;
}

}  // namespace

std::string format_joint_origins_yaml(const UrdfJointPositions& joints, const ModelPatch& patch) {
  std::string text =
      "# Calibrated joint origins [m, rad]: of the joint in its parent link, angles as rpy of URDF.\n"
      "joint_origins:\n";
  for (const UrdfJointPosition& joint : joints.joints)
    if (!joint.is_fixed) text += fmt::format("  {}:\n{}", yaml_key(joint.name), six_numbers(joint, "    "));
  if (patch.offsets == EncoderOffsets::folded) return text;
  return text + "\n" + format_joint_offsets_yaml(patch);
}

std::string format_joint_offsets_yaml(const ModelPatch& patch) {
  std::string text =
      "# To be added to the joint positions of the controller [rad, m]; not part of the origins.\njoint_offsets:\n";
  for (const OriginChange& change : patch.changes)
    text += fmt::format("  {}: {}\n", yaml_key(change.joint), format_number(change.offset));
  return text;
}

std::optional<std::string> format_kinematics_yaml(const UrdfJointPositions& joints) {
  if (auto text = universal_robots(joints)) return text;
  return franka(joints);
}

}  // namespace kinfer
