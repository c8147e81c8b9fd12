// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameter_address.hpp"

#include <fmt/format.h>

#include <type_traits>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr Field frame_fields[] = {Field::x, Field::y, Field::z, Field::rx, Field::ry, Field::rz};
constexpr Field plane_fields[] = {Field::rx, Field::ry, Field::offset};

std::string_view field_name(Field field) {
  constexpr std::string_view names[] = {
      "x",        "y",   "z",     "rx",     "ry",      "rz",         "a",
      "alpha",    "d",   "theta", "beta",   "gain",    "compliance", "torque_compliance",
      "backlash", "sin", "cos",   "offset", "coupling"};
  return names[static_cast<int>(field)];
}

std::string label_of(const Vec3&, std::string_view kind, int index) {
  return fmt::format("{}{}", kind, index + 1);
}
template <class Named>
std::string label_of(const Named& fixture, std::string_view kind, int) {
  return fmt::format("{}_{}", kind, fixture.name);
}

/// As in files.
struct NameOfNumber {
  const Chain& chain;

  std::string operator()(const FrameNumber& at) const {
    const std::string name = fmt::format("{}_{}", at.frame == SetupFrame::base ? "base" : "tool", field_name(at.field));
    return at.mounting < 0 ? name : fmt::format("{}@{}", name, chain.mountings[at.mounting].name);
  }
  std::string operator()(const JointNumber& at) const {
    const Joint& joint = chain.joints[at.joint];
    if (at.field == Field::sine || at.field == Field::cosine)
      return fmt::format("{}{:g}q{}", field_name(at.field), joint.harmonics[at.term].order, at.joint + 1);
    if (at.field == Field::coupling)
      return fmt::format("coupling{}_{}", at.joint + 1, joint.couplings[at.term].joint + 1);
    return fmt::format("{}{}", field_name(at.field), at.joint + 1);
  }
  std::string operator()(const TargetNumber& at) const {
    return fmt::format("target_{}_{}", chain.targets[at.target].name, field_name(at.field));
  }
  std::string operator()(const FixtureNumber& at) const {
    std::string name;
    for_each_fixture_list(chain.fixtures, [&](const auto& row, const auto& list) {
      if (fixture_kind(row.kind) == at.kind) name = label_of(list[at.index], row.kind, at.index);
    });
    return fmt::format("{}_{}", name, field_name(at.field));
  }
  std::string operator()(const GravityNumber& at) const { return fmt::format("gravity_{}", field_name(at.field)); }
  std::string operator()(const ExpansionNumber&) const { return "expansion"; }
};

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
auto* link_or_joint_number(J& joint, Field field) {
  if (field == Field::gain) return &joint.gain;
  if (field == Field::compliance) return &joint.compliance;
  if (field == Field::torque_compliance) return &joint.torque_compliance;
  if (field == Field::backlash) return &joint.backlash;
  return std::visit([&](auto& link) { return link_number(link, field); }, joint.link);
}

template <class P>
auto* plane_number(P& plane, Field field) {
  KINFER_EXPECT(field == Field::rx || field == Field::ry || field == Field::offset, "a plane has no {}",
                field_name(field));
  return field == Field::offset ? &plane.offset : &plane.small_rotation[field == Field::rx ? 0 : 1];
}

template <class V>
auto* point_number(V& xyz, Field field) {
  KINFER_EXPECT(is_translation(field), "a point has no {}", field_name(field));
  return &xyz[static_cast<int>(field) - static_cast<int>(Field::x)];
}

template <class Fixture>
auto* fixture_number(Fixture& fixture, Field field) {
  using Kind = std::remove_const_t<Fixture>;
  if constexpr (std::is_same_v<Kind, Vec3>) return point_number(fixture, field);
  if constexpr (std::is_same_v<Kind, Target>) return point_number(fixture.xyz, field);
  if constexpr (std::is_same_v<Kind, Plane>) return plane_number(fixture, field);
  if constexpr (std::is_same_v<Kind, NamedFrame>) return frame_number(fixture.frame, field);
}

template <class List>
auto& entry(List& list, int index) {
  KINFER_EXPECT(index >= 0 && index < static_cast<int>(list.size()), "entry {} of {}", index, list.size());
  return list[index];
}

/// Finds the number; the chain may be const.
template <class C>
struct FindNumber {
  C& chain;

  auto* operator()(const FrameNumber& at) const {
    if (at.mounting < 0) return frame_number(at.frame == SetupFrame::base ? chain.base : chain.tool, at.field);
    auto& mounting = entry(chain.mountings, at.mounting);
    return frame_number(at.frame == SetupFrame::base ? *mounting.base : mounting.tool, at.field);
  }
  auto* operator()(const JointNumber& at) const {
    KINFER_EXPECT(at.joint >= 0 && at.joint < static_cast<int>(chain.joints.size()), "joint {} of {}", at.joint,
                  chain.joints.size());
    auto& joint = chain.joints[at.joint];
    if (at.field == Field::sine) return &entry(joint.harmonics, at.term).sine;
    if (at.field == Field::cosine) return &entry(joint.harmonics, at.term).cosine;
    if (at.field == Field::coupling) return &entry(joint.couplings, at.term).factor;
    return link_or_joint_number(joint, at.field);
  }
  auto* operator()(const TargetNumber& at) const { return point_number(entry(chain.targets, at.target).xyz, at.field); }
  auto* operator()(const FixtureNumber& at) const {
    decltype(&chain.expansion) number = nullptr;
    for_each_fixture_list(chain.fixtures, [&](const auto& row, auto& list) {
      if (fixture_kind(row.kind) == at.kind) number = fixture_number(entry(list, at.index), at.field);
    });
    return number;
  }
  auto* operator()(const GravityNumber& at) const { return point_number(chain.gravity, at.field); }
  auto* operator()(const ExpansionNumber&) const { return &chain.expansion; }
};

template <class C>
auto* find_number(C& chain, const ParameterAddress& at) {
  return std::visit(FindNumber<C>{chain}, at);
}

}  // namespace

Quantity quantity_of(const ParameterAddress& at) {
  if (std::holds_alternative<GravityNumber>(at)) return Quantity::acceleration;
  const std::optional<Field> field = field_of(at);
  if (!field) return Quantity::expansion;
  switch (*field) {
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
    default:
      return Quantity::angle;
  }
}

std::string name_of(const Chain& chain, const ParameterAddress& at) {
  return std::visit(NameOfNumber{chain}, at);
}

bool is_own_frame_parameter(const ParameterAddress& at, SetupFrame frame) {
  const auto* number = std::get_if<FrameNumber>(&at);
  return number && number->frame == frame && number->mounting < 0;
}

bool is_object_parameter(const ParameterAddress& at) {
  return std::holds_alternative<TargetNumber>(at) || std::holds_alternative<FixtureNumber>(at);
}

std::optional<Field> field_of(const ParameterAddress& at) {
  return std::visit(
      [](const auto& number) -> std::optional<Field> {
        if constexpr (requires { number.field; }) return number.field;
        return std::nullopt;
      },
      at);
}

bool is_translation(Field field) {
  return field == Field::x || field == Field::y || field == Field::z;
}
bool is_rotation(Field field) {
  return field == Field::rx || field == Field::ry || field == Field::rz;
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

std::vector<ParameterAddress> non_geometric_addresses(const Chain& chain) {
  std::vector<ParameterAddress> addresses;
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j) {
    const Joint& joint = chain.joints[j];
    for (const Field field : {Field::gain, Field::compliance, Field::torque_compliance, Field::backlash})
      addresses.push_back(JointNumber{j, field});
    for (int term = 0; term < static_cast<int>(joint.harmonics.size()); ++term)
      for (const Field field : {Field::sine, Field::cosine}) addresses.push_back(JointNumber{j, field, term});
    for (int term = 0; term < static_cast<int>(joint.couplings.size()); ++term)
      addresses.push_back(JointNumber{j, Field::coupling, term});
  }
  addresses.push_back(ExpansionNumber{});
  return addresses;
}

std::string_view unit(Quantity quantity) {
  constexpr std::string_view units[] = {"m", "rad", "1", "rad/(N m)", "1/K", "m/s^2"};
  return units[static_cast<int>(quantity)];
}

double value_at(const Chain& chain, const ParameterAddress& address) {
  return *find_number(chain, address);
}

void set_value_at(Chain& chain, const ParameterAddress& address, double value) {
  *find_number(chain, address) = value;
}

}  // namespace kinfer
