#include "kinfer/kinematics/parameters.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr Field frame_fields[] = {Field::x, Field::y, Field::z, Field::rx, Field::ry, Field::rz};
constexpr Field dh_fields[] = {Field::a, Field::alpha, Field::d, Field::theta, Field::beta};

std::string_view field_name(Field field) {
  constexpr std::string_view names[] = {"x",     "y", "z",     "rx",   "ry",   "rz",        "a",
                                        "alpha", "d", "theta", "beta", "gain", "compliance"};
  return names[static_cast<int>(field)];
}

Quantity quantity_of(Field field) {
  switch (field) {
    case Field::x:
    case Field::y:
    case Field::z:
    case Field::a:
    case Field::d:
      return Quantity::length;
    case Field::gain:
      return Quantity::ratio;
    case Field::compliance:
      return Quantity::compliance;
    default:
      return Quantity::angle;
  }
}

std::string name_of(const Address& at) {
  switch (at.owner) {
    case Owner::base:
      return fmt::format("base_{}", field_name(at.field));
    case Owner::tool:
      return fmt::format("tool_{}", field_name(at.field));
    default:
      return fmt::format("{}{}", field_name(at.field), at.joint + 1);
  }
}

double tolerance_of(const Address& at, const Tolerances& t) {
  const Quantity quantity = quantity_of(at.field);
  if (quantity == Quantity::ratio) return t.gain;
  if (quantity == Quantity::compliance) return t.compliance;
  const bool is_length = quantity == Quantity::length;
  if (at.owner == Owner::base) return is_length ? t.base_length : t.base_angle;
  if (at.owner == Owner::tool) return is_length ? t.tool_length : t.tool_angle;
  return is_length ? t.length : t.angle;
}

void append(ParameterSet& set, const Chain& chain, const Address& at, const Tolerances& tolerances) {
  const double tolerance = tolerance_of(at, tolerances);
  set.parameters.push_back({.name = name_of(at),
                            .quantity = quantity_of(at.field),
                            .at = at,
                            .nominal = value_at(chain, at),
                            .scale = tolerance,
                            .prior_sd = tolerance});
}

std::vector<Field> fields_of(const Joint& joint) {
  std::vector<Field> fields;
  if (std::holds_alternative<UrdfLink>(joint.link)) {
    fields.assign(std::begin(frame_fields), std::end(frame_fields));
  } else {
    fields.assign(std::begin(dh_fields), std::end(dh_fields));
  }
  if (joint.has_reading && joint.type != JointType::fixed) fields.push_back(Field::gain);
  if (joint.type == JointType::revolute) fields.push_back(Field::compliance);
  return fields;
}

/// The functions below find a number of the chain for reading and for writing: C is Chain or const Chain.
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
      return &frame.turn[static_cast<int>(field) - static_cast<int>(Field::rx)];
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
  return std::visit([&](auto& link) { return link_number(link, field); }, joint.link);
}

template <class C>
auto* number(C& chain, const Address& at) {
  if (at.owner == Owner::base) return frame_number(chain.base, at.field);
  if (at.owner == Owner::tool) return frame_number(chain.tool, at.field);
  KINFER_EXPECT(at.joint >= 0 && at.joint < static_cast<int>(chain.joints.size()), "joint {} of {}", at.joint,
                chain.joints.size());
  return joint_number(chain.joints[at.joint], at.field);
}

}  // namespace

std::string_view unit(Quantity quantity) {
  constexpr std::string_view units[] = {"m", "rad", "1", "rad/(N m)"};
  return units[static_cast<int>(quantity)];
}

Eigen::Index ParameterSet::free_count() const {
  return std::count_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.free; });
}

const Parameter* ParameterSet::find(std::string_view name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

std::vector<const Parameter*> ParameterSet::free() const {
  std::vector<const Parameter*> list;
  for (const Parameter& p : parameters) {
    if (p.free) list.push_back(&p);
  }
  return list;
}

ParameterSet all_parameters(const Chain& chain, const Tolerances& tolerances) {
  expect_well_formed(chain);
  ParameterSet set;
  for (const Field field : frame_fields) append(set, chain, {Owner::base, -1, field}, tolerances);
  for (const int j : path_to(chain, chain.tip_joint())) {
    for (const Field field : fields_of(chain.joints[j])) append(set, chain, {Owner::joint, j, field}, tolerances);
  }
  for (const Field field : frame_fields) append(set, chain, {Owner::tool, -1, field}, tolerances);
  return set;
}

ParameterSet with_only_free(ParameterSet set, const std::vector<std::string>& names) {
  for (const std::string& name : names) KINFER_EXPECT(set.find(name), "no parameter is called {}", name);
  for (Parameter& p : set.parameters) p.free = std::find(names.begin(), names.end(), p.name) != names.end();
  return set;
}

double value_at(const Chain& chain, const Address& address) {
  return *number(chain, address);
}

void set_value_at(Chain& chain, const Address& address, double value) {
  *number(chain, address) = value;
}

VectorXd pack(const ParameterSet& set, const Chain& chain) {
  VectorXd x(set.free_count());
  Eigen::Index i = 0;
  for (const Parameter& p : set.parameters) {
    if (p.free) x[i++] = value_at(chain, p.at);
  }
  return x;
}

Chain unpack(const ParameterSet& set, const Chain& nominal, ConstVectorRef x) {
  KINFER_EXPECT(x.size() == set.free_count(), "{} values for {} free parameters", x.size(), set.free_count());
  Chain chain = nominal;
  Eigen::Index i = 0;
  for (const Parameter& p : set.parameters) {
    if (p.free) set_value_at(chain, p.at, x[i++]);
  }
  return chain;
}

}  // namespace kinfer
