// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameters.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr Field frame_fields[] = {Field::x, Field::y, Field::z, Field::rx, Field::ry, Field::rz};
constexpr Field dh_fields[] = {Field::a, Field::alpha, Field::d, Field::theta, Field::beta};

std::string_view field_name(Field field) {
  constexpr std::string_view names[] = {
      "x",        "y",   "z",     "rx",        "ry",     "rz",         "a",
      "alpha",    "d",   "theta", "beta",      "gain",   "compliance", "torque_compliance",
      "backlash", "sin", "cos",   "expansion", "offset", "coupling"};
  return names[static_cast<int>(field)];
}

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

std::string name_of_joint_number(const Chain& chain, const ParameterAddress& at) {
  if (at.field == Field::sine || at.field == Field::cosine)
    return fmt::format("{}{:g}q{}", field_name(at.field), chain.joints[at.joint].harmonics[at.term].order,
                       at.joint + 1);
  if (at.field == Field::coupling)
    return fmt::format("coupling{}_{}", at.joint + 1, chain.joints[at.joint].couplings[at.term].joint + 1);
  return fmt::format("{}{}", field_name(at.field), at.joint + 1);
}

std::string name_of(const Chain& chain, const ParameterAddress& at) {
  const std::string_view field = field_name(at.field);
  const Fixtures& fixtures = chain.fixtures;
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
    case Owner::anchor:
      return fmt::format("anchor{}_{}", at.joint + 1, field);
    case Owner::socket:
      return fmt::format("socket_{}_{}", fixtures.sockets[at.joint].name, field);
    case Owner::plane:
      return fmt::format("plane_{}_{}", fixtures.planes[at.joint].name, field);
    case Owner::gravity:
      return fmt::format("gravity_{}", field);
    case Owner::robot:
      break;
  }
  return std::string(field);
}

double tolerance_of(const ParameterAddress& at, const Tolerances& t) {
  const Quantity quantity = quantity_of(at);
  if (quantity == Quantity::ratio) return t.gain;
  if (quantity == Quantity::compliance) return t.compliance;
  const bool is_length = quantity == Quantity::length;
  switch (at.owner) {
    case Owner::base:
    case Owner::mounting_base:
      return is_length ? t.base_length : t.base_angle;
    case Owner::tool:
    case Owner::mounting_tool:
    case Owner::target:
      return is_length ? t.tool_length : t.tool_angle;
    case Owner::anchor:
      return t.anchor;
    default:
      return is_length ? t.length : t.angle;
  }
}

void append(ParameterSet& set, const Chain& chain, const ParameterAddress& at, const Tolerances& tolerances) {
  set.parameters.push_back(parameter_at(chain, at, tolerance_of(at, tolerances)));
}

/// A parameter without a prior.
void append_unknown(ParameterSet& set, const Chain& chain, const ParameterAddress& at) {
  Parameter parameter = parameter_at(chain, at, std::numeric_limits<double>::infinity());
  parameter.scale = 1e-2;  // [m] or [rad]
  set.parameters.push_back(parameter);
}

std::vector<Field> fields_of(const Joint& joint) {
  std::vector<Field> fields;
  if (std::holds_alternative<UrdfLink>(joint.link)) {
    fields.assign(std::begin(frame_fields), std::end(frame_fields));
  } else {
    fields.assign(std::begin(dh_fields), std::end(dh_fields));
  }
  if (joint.is_active && joint.type != JointType::fixed) fields.push_back(Field::gain);
  if (joint.type == JointType::revolute) fields.push_back(Field::compliance);
  return fields;
}

/// Joints on the path to the tip or to that of a further mounting, ascending.
std::vector<int> joints_on_tool_paths(const Chain& chain) {
  std::vector<int> joints = path_to(chain, chain.tip_joint());
  for (const RobotMounting& mounting : chain.mountings) {
    if (mounting.tip < 0) continue;
    const std::vector<int> path = path_to(chain, mounting.tip);
    joints.insert(joints.end(), path.begin(), path.end());
  }
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
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

template <class P>
auto* plane_number(P& plane, Field field) {
  return field == Field::offset ? &plane.offset : &plane.small_rotation[field == Field::rx ? 0 : 1];
}

template <class List>
auto& entry(List& list, int index) {
  KINFER_EXPECT(index >= 0 && index < static_cast<int>(list.size()), "entry {} of {}", index, list.size());
  return list[index];
}

template <class C>
auto* number(C& chain, const ParameterAddress& at) {
  const auto axis = static_cast<int>(at.field) - static_cast<int>(Field::x);
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
      return &entry(chain.targets, at.joint).xyz[axis];
    case Owner::anchor:
      return &entry(chain.fixtures.anchors, at.joint)[axis];
    case Owner::socket:
      return &entry(chain.fixtures.sockets, at.joint).xyz[axis];
    case Owner::plane:
      return plane_number(entry(chain.fixtures.planes, at.joint), at.field);
    case Owner::gravity:
      return &chain.gravity[axis];
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

std::string_view unit(Quantity quantity) {
  constexpr std::string_view units[] = {"m", "rad", "1", "rad/(N m)", "1/K", "m/s^2"};
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
  for (const int j : joints_on_tool_paths(chain)) {
    for (const Field field : fields_of(chain.joints[j])) append(set, chain, {Owner::joint, j, field}, tolerances);
    for (int k = 0; k < static_cast<int>(chain.joints[j].couplings.size()); ++k)
      append(set, chain, {Owner::joint, j, Field::coupling, k}, tolerances);
  }
  for (const Field field : frame_fields) append(set, chain, {Owner::tool, -1, field}, tolerances);
  return set;
}

ParameterSet setup_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set;
  const auto xyz = {Field::x, Field::y, Field::z};
  for (int m = 0; m < static_cast<int>(chain.mountings.size()); ++m) {
    for (const Field field : frame_fields)
      if (chain.mountings[m].base) append(set, chain, {Owner::mounting_base, m, field}, tolerances);
    for (const Field field : frame_fields) append(set, chain, {Owner::mounting_tool, m, field}, tolerances);
  }
  for (int i = 0; i < static_cast<int>(chain.targets.size()); ++i)
    for (const Field field : xyz) append(set, chain, {Owner::target, i, field}, tolerances);
  const Fixtures& fixtures = chain.fixtures;
  for (int i = 0; i < static_cast<int>(fixtures.anchors.size()); ++i)
    for (const Field field : xyz) append(set, chain, {Owner::anchor, i, field}, tolerances);
  for (int i = 0; i < static_cast<int>(fixtures.sockets.size()); ++i)
    for (const Field field : xyz) append_unknown(set, chain, {Owner::socket, i, field});
  for (int i = 0; i < static_cast<int>(fixtures.planes.size()); ++i)
    for (const Field field : {Field::rx, Field::ry, Field::offset})
      append_unknown(set, chain, {Owner::plane, i, field});
  return set;
}

Parameter parameter_at(const Chain& chain, const ParameterAddress& at, double prior_sd) {
  return {.name = name_of(chain, at),
          .quantity = quantity_of(at),
          .at = at,
          .nominal = value_at(chain, at),
          .scale = prior_sd,
          .prior_sd = prior_sd};
}

ParameterSet with_only_free(ParameterSet set, const std::vector<std::string>& names) {
  for (const std::string& name : names) KINFER_EXPECT(set.find(name), "no parameter is called {}", name);
  for (Parameter& p : set.parameters) p.free = std::find(names.begin(), names.end(), p.name) != names.end();
  set.prior_sqrt_information.resize(0, 0);
  return set;
}

double value_at(const Chain& chain, const ParameterAddress& address) {
  return *number(chain, address);
}

void set_value_at(Chain& chain, const ParameterAddress& address, double value) {
  *number(chain, address) = value;
}

MatrixXd prior_sqrt_information_of(const ParameterSet& set) {
  const std::vector<const Parameter*> free = set.free();
  const auto n = static_cast<Eigen::Index>(free.size());
  if (set.prior_sqrt_information.size() > 0) {
    KINFER_EXPECT(set.prior_sqrt_information.cols() == n, "a prior of {} parameters for {} free ones",
                  set.prior_sqrt_information.cols(), n);
    return set.prior_sqrt_information;
  }
  MatrixXd rows = MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) rows(k, k) = 1.0 / free[k]->prior_sd;  // 0 where there is no prior
  return rows;
}

VectorXd nominal_of(const ParameterSet& set) {
  VectorXd nominal(set.free_count());
  Eigen::Index k = 0;
  for (const Parameter* p : set.free()) nominal[k++] = p->nominal;
  return nominal;
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
