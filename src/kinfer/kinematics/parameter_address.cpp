// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameter_address.hpp"

#include <fmt/format.h>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr Field frame_fields[] = {Field::x, Field::y, Field::z, Field::rx, Field::ry, Field::rz};
constexpr Field plane_fields[] = {Field::rx, Field::ry, Field::offset};

std::string_view field_name(Field field) {
  constexpr std::string_view names[] = {
      "x",        "y",   "z",     "rx",        "ry",     "rz",         "a",
      "alpha",    "d",   "theta", "beta",      "gain",   "compliance", "torque_compliance",
      "backlash", "sin", "cos",   "expansion", "offset", "coupling"};
  return names[static_cast<int>(field)];
}

std::string name_of_joint_number(const Chain& chain, const ParameterAddress& at) {
  if (at.field == Field::sine || at.field == Field::cosine)
    return fmt::format("{}{:g}q{}", field_name(at.field), chain.joints[at.joint].harmonics[at.term].order,
                       at.joint + 1);
  if (at.field == Field::coupling)
    return fmt::format("coupling{}_{}", at.joint + 1, chain.joints[at.joint].couplings[at.term].joint + 1);
  return fmt::format("{}{}", field_name(at.field), at.joint + 1);
}

std::string label_of(const Vec3&, std::string_view kind, int index) {
  return fmt::format("{}{}", kind, index + 1);
}
template <class Named>
std::string label_of(const Named& fixture, std::string_view kind, int) {
  return fmt::format("{}_{}", kind, fixture.name);
}

std::string name_of_fixture(const Fixtures& fixtures, const ParameterAddress& at) {
  std::string name;
  for_each_fixture_list(fixtures, [&](const auto& row, const auto& list) {
    if (fixture_kind(row.kind) == at.fixture) name = label_of(list[at.joint], row.kind, at.joint);
  });
  return fmt::format("{}_{}", name, field_name(at.field));
}

/// The functions below find a number of the chain for read and write access: the chain and its parts may be const.
template <class F>
auto* frame_number(F& frame, Field field) {
  switch (field) {
    case Field::x:
    case Field::y:
    case Field::z:
      return &frame.xyz[static_cast<int>(field) - static_cast<int>(Field::x)];
    case Field::rx:
    case Field::ry:
    case Field::rz:
      return &frame.small_rotation[static_cast<int>(field) - static_cast<int>(Field::rx)];
    default:
      KINFER_EXPECT(false, "a frame has no {}", field_name(field));
      return &frame.xyz[0];
  }
}

template <class Dh>
auto* link_number(Dh& row, Field field) {
  switch (field) {
    case Field::a:
      return &row.a;
    case Field::alpha:
      return &row.alpha;
    case Field::d:
      return &row.d;
    case Field::theta:
      return &row.theta;
    case Field::beta:
      return &row.beta;
    default:
      KINFER_EXPECT(false, "a DH row has no {}", field_name(field));
      return &row.a;
  }
}

auto* link_number(UrdfLink& link, Field field) {
  return frame_number(link.origin, field);
}
auto* link_number(const UrdfLink& link, Field field) {
  return frame_number(link.origin, field);
}

template <class J>
auto* joint_number(J& joint, Field field) {
  if (field == Field::gain) return &joint.gain;
  if (field == Field::compliance) return &joint.compliance;
  if (field == Field::torque_compliance) return &joint.torque_compliance;
  if (field == Field::backlash) return &joint.backlash;
  return std::visit([&](auto& link) { return link_number(link, field); }, joint.link);
}

double* plane_number(Plane& plane, Field field) {
  KINFER_EXPECT(field == Field::rx || field == Field::ry || field == Field::offset, "a plane has no {}",
                field_name(field));
  return field == Field::offset ? &plane.offset : &plane.small_rotation[field == Field::rx ? 0 : 1];
}

template <class V>
auto* point_number(V& xyz, Field field) {
  KINFER_EXPECT(field <= Field::z, "a point has no {}", field_name(field));
  return &xyz[static_cast<int>(field) - static_cast<int>(Field::x)];
}

double* fixture_number(Vec3& point, Field field) {
  return point_number(point, field);
}
double* fixture_number(Target& point, Field field) {
  return point_number(point.xyz, field);
}
double* fixture_number(Plane& plane, Field field) {
  return plane_number(plane, field);
}
double* fixture_number(NamedFrame& fixture, Field field) {
  return frame_number(fixture.frame, field);
}

template <class List>
auto& entry(List& list, int index) {
  KINFER_EXPECT(index >= 0 && index < static_cast<int>(list.size()), "entry {} of {}", index, list.size());
  return list[index];
}

double* fixture_number(Fixtures& fixtures, const ParameterAddress& at) {
  double* number = nullptr;
  for_each_fixture_list(fixtures, [&](const auto& row, auto& list) {
    if (fixture_kind(row.kind) == at.fixture) number = fixture_number(entry(list, at.joint), at.field);
  });
  return number;
}
const double* fixture_number(const Fixtures& fixtures, const ParameterAddress& at) {
  return fixture_number(const_cast<Fixtures&>(fixtures), at);
}

template <class C>
auto* number(C& chain, const ParameterAddress& at) {
  switch (at.owner) {
    case Owner::base:
      return frame_number(chain.base, at.field);
    case Owner::tool:
      return frame_number(chain.tool, at.field);
    case Owner::mounting_base:
      return frame_number(*entry(chain.mountings, at.joint).base, at.field);
    case Owner::mounting_tool:
      return frame_number(entry(chain.mountings, at.joint).tool, at.field);
    case Owner::target:
      return point_number(entry(chain.targets, at.joint).xyz, at.field);
    case Owner::fixture:
      return fixture_number(chain.fixtures, at);
    case Owner::gravity:
      return point_number(chain.gravity, at.field);
    case Owner::robot:
      return &chain.expansion;
    case Owner::joint:
      break;
  }
  KINFER_EXPECT(at.joint >= 0 && at.joint < static_cast<int>(chain.joints.size()), "joint {} of {}", at.joint,
                chain.joints.size());
  auto& joint = chain.joints[at.joint];
  if (at.field == Field::sine) return &entry(joint.harmonics, at.term).sine;
  if (at.field == Field::cosine) return &entry(joint.harmonics, at.term).cosine;
  if (at.field == Field::coupling) return &entry(joint.couplings, at.term).factor;
  return joint_number(joint, at.field);
}

}  // namespace

Quantity quantity_of(const ParameterAddress& at) {
  if (at.owner == Owner::gravity) return Quantity::acceleration;
  switch (at.field) {
    case Field::x:
    case Field::y:
    case Field::z:
    case Field::a:
    case Field::d:
    case Field::offset:
      return Quantity::length;
    case Field::gain:
    case Field::coupling:
      return Quantity::ratio;
    case Field::compliance:
    case Field::torque_compliance:
      return Quantity::compliance;
    case Field::expansion:
      return Quantity::expansion;
    default:
      return Quantity::angle;
  }
}

std::string name_of(const Chain& chain, const ParameterAddress& at) {
  const std::string_view field = field_name(at.field);
  switch (at.owner) {
    case Owner::base:
      return fmt::format("base_{}", field);
    case Owner::tool:
      return fmt::format("tool_{}", field);
    case Owner::joint:
      return name_of_joint_number(chain, at);
    case Owner::mounting_base:
      return fmt::format("base_{}@{}", field, chain.mountings[at.joint].name);
    case Owner::mounting_tool:
      return fmt::format("tool_{}@{}", field, chain.mountings[at.joint].name);
    case Owner::target:
      return fmt::format("target_{}_{}", chain.targets[at.joint].name, field);
    case Owner::fixture:
      return name_of_fixture(chain.fixtures, at);
    case Owner::gravity:
      return fmt::format("gravity_{}", field);
    case Owner::robot:
      break;
  }
  return std::string(field);
}

bool is_frame_parameter(const ParameterAddress& at) {
  return at.owner == Owner::base || at.owner == Owner::tool || at.owner == Owner::mounting_base ||
         at.owner == Owner::mounting_tool;
}

std::span<const Field> fields_of(const Vec3&) {
  return std::span(frame_fields).first<3>();
}
std::span<const Field> fields_of(const Target&) {
  return std::span(frame_fields).first<3>();
}
std::span<const Field> fields_of(const Plane&) {
  return plane_fields;
}
std::span<const Field> fields_of(const NamedFrame&) {
  return frame_fields;
}

std::string_view unit(Quantity quantity) {
  constexpr std::string_view units[] = {"m", "rad", "1", "rad/(N m)", "1/K", "m/s^2"};
  return units[static_cast<int>(quantity)];
}

double value_at(const Chain& chain, const ParameterAddress& address) {
  return *number(chain, address);
}

void set_value_at(Chain& chain, const ParameterAddress& address, double value) {
  *number(chain, address) = value;
}

}  // namespace kinfer
