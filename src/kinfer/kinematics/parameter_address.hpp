// SPDX-License-Identifier: Apache-2.0
// Addresses of the numbers of a chain: their names, quantities and values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// [m], [rad], [1], [rad/(N m)], [1/K], [m/s²]
enum class Quantity { length, angle, ratio, compliance, expansion, acceleration };
std::string_view unit(Quantity quantity);  ///< "m", "rad", "1", "rad/(N m)", "1/K", "m/s^2"

/// Component of a frame, row of a link or property of a joint.
enum class Field {
  x,
  y,
  z,
  rx,
  ry,
  rz,
  a,
  alpha,
  d,
  theta,
  beta,
  gain,
  compliance,
  torque_compliance,
  backlash,
  sine,
  cosine,
  offset,
  coupling
};

enum class SetupFrame { base, tool };

/// Of a base or tool frame.
struct FrameNumber {
  SetupFrame frame;
  Field field;
  int mounting = -1;  ///< index into Chain::mountings; −1: the chain's own
  bool operator==(const FrameNumber&) const = default;
};
/// Of a joint or its link.
struct JointNumber {
  int joint;  ///< index into Chain::joints
  Field field;
  int term = 0;  ///< sine and cosine: index into Joint::harmonics; coupling: into Joint::couplings
  bool operator==(const JointNumber&) const = default;
};
/// Coordinate of a further target, in the tool frame.
struct TargetNumber {
  int target;  ///< index into Chain::targets
  Field field;
  bool operator==(const TargetNumber&) const = default;
};
/// Of a fixture that measurements refer to.
struct FixtureNumber {
  FixtureKind kind;
  int index;  ///< into the list of that kind
  Field field;
  bool operator==(const FixtureNumber&) const = default;
};
/// Component of the gravity vector.
struct GravityNumber {
  Field field;
  bool operator==(const GravityNumber&) const = default;
};
/// Thermal expansion coefficient of the robot.
struct ExpansionNumber {
  bool operator==(const ExpansionNumber&) const = default;
};

/// Which number of a chain a parameter is.
using ParameterAddress =
    std::variant<FrameNumber, JointNumber, TargetNumber, FixtureNumber, GravityNumber, ExpansionNumber>;

/// Null where it is no number of a joint.
inline const JointNumber* joint_number(const ParameterAddress& at) {
  return std::get_if<JointNumber>(&at);
}
inline bool is_joint_parameter(const ParameterAddress& at) {
  return joint_number(at) != nullptr;
}
/// Of the base or tool, in the chain's own set-up or in a mounting.
inline bool is_frame_parameter(const ParameterAddress& at) {
  return std::holds_alternative<FrameNumber>(at);
}
/// Of the chain's own base or tool, not that of a further mounting.
bool is_own_frame_parameter(const ParameterAddress& at, SetupFrame frame);
/// Of a further target or a fixture.
bool is_object_parameter(const ParameterAddress& at);

/// None for the thermal expansion.
std::optional<Field> field_of(const ParameterAddress& at);
bool is_translation(Field field);  ///< x, y, z
bool is_rotation(Field field);     ///< rx, ry, rz

/// The numbers of a fixture, in the order of its parameters.
std::span<const Field> fields_of(const Vec3& point);
std::span<const Field> fields_of(const Target& point);
std::span<const Field> fields_of(const Plane& plane);
std::span<const Field> fields_of(const NamedFrame& frame);

/// Every number that the chain has beyond its geometry: gain, compliances, backlash, harmonics and couplings of each
/// joint, thermal expansion.
std::vector<ParameterAddress> non_geometric_addresses(const Chain& chain);

/// As in files: "a6", "tool_rz", "base_x@left", "socket_ball_x".
std::string name_of(const Chain& chain, const ParameterAddress& at);
Quantity quantity_of(const ParameterAddress& at);

/// Programming error if the chain has no such number.
double value_at(const Chain& chain, const ParameterAddress& address);
void set_value_at(Chain& chain, const ParameterAddress& address, double value);

}  // namespace kinfer
