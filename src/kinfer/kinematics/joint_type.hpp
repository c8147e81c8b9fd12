// SPDX-License-Identifier: Apache-2.0
// Types of joints: a table with one row per type, which models and file formats read.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace kinfer {

namespace elementary {
enum class Motion { rotation, translation };
}  // namespace elementary

enum class JointType { revolute, prismatic, fixed };

struct JointTypeTraits {
  JointType type;
  std::string_view name;                     ///< in robot files, evidence.json and tables
  std::string_view urdf, urdf_unlimited;     ///< type of a URDF joint with and without limits
  std::string_view mjcf;                     ///< type of an MJCF joint; empty: no joint element
  std::optional<elementary::Motion> motion;  ///< about or along the joint's axis; none: it does not move
};

inline constexpr std::array<JointTypeTraits, 3> joint_types{{
    {JointType::revolute, "revolute", "revolute", "continuous", "hinge", elementary::Motion::rotation},
    {JointType::prismatic, "prismatic", "prismatic", "prismatic", "slide", elementary::Motion::translation},
    {JointType::fixed, "fixed", "fixed", "fixed", "", std::nullopt},
}};

constexpr const JointTypeTraits& traits(JointType type) {
  return joint_types[static_cast<std::size_t>(type)];
}

/// The joint position is an angle [rad].
constexpr bool rotates(JointType type) {
  return traits(type).motion == elementary::Motion::rotation;
}

/// The joint position is a length [m].
constexpr bool translates(JointType type) {
  return traits(type).motion == elementary::Motion::translation;
}

/// The type has a joint position; the joint may still be inactive (Joint::is_active).
constexpr bool has_position(JointType type) {
  return traits(type).motion.has_value();
}

/// The type of that name; nullopt for another name.
std::optional<JointType> joint_type_named(std::string_view name);

/// "revolute", "prismatic" or "fixed", quoted, for error texts.
std::string joint_type_names();

}  // namespace kinfer
