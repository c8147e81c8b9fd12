// SPDX-License-Identifier: Apache-2.0
// Addresses of the numbers of a chain: their names, quantities and values.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// [m], [rad], [1], [rad/(N m)], [1/K], [m/s²]
enum class Quantity { length, angle, ratio, compliance, expansion, acceleration };
std::string_view unit(Quantity quantity);  ///< "m", "rad", "1", "rad/(N m)", "1/K", "m/s^2"

/// Which number of a chain a parameter is.
enum class Owner { base, joint, tool, robot, mounting_base, mounting_tool, target, fixture, gravity };
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
  expansion,
  offset,
  coupling
};
struct ParameterAddress {
  Owner owner = Owner::joint;
  int joint = -1;  ///< index into Chain::joints, or into the list of that owner (mountings, targets, a kind of fixture)
  Field field = Field::a;
  int term = 0;              ///< sine and cosine: index into Joint::harmonics; coupling: into Joint::couplings
  FixtureKind fixture = {};  ///< of Owner::fixture
  bool operator==(const ParameterAddress&) const = default;
};

inline bool is_joint_parameter(const ParameterAddress& at) {
  return at.owner == Owner::joint;
}
inline bool is_fixture_parameter(const ParameterAddress& at) {
  return at.owner == Owner::fixture;
}
/// Of the base or tool, in the chain's own set-up or in a mounting.
bool is_frame_parameter(const ParameterAddress& at);

/// The numbers of a fixture, in the order of its parameters.
std::span<const Field> fields_of(const Vec3& point);
std::span<const Field> fields_of(const Target& point);
std::span<const Field> fields_of(const Plane& plane);
std::span<const Field> fields_of(const NamedFrame& frame);

/// As in files: "a6", "tool_rz", "base_x@left", "socket_ball_x".
std::string name_of(const Chain& chain, const ParameterAddress& at);
Quantity quantity_of(const ParameterAddress& at);

/// Programming error if the chain has no such number.
double value_at(const Chain& chain, const ParameterAddress& address);
void set_value_at(Chain& chain, const ParameterAddress& address, double value);

}  // namespace kinfer
