// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/parameters/parameter_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer::calibrate {
namespace {

bool is_rotation(Field field) {
  return field == Field::rx || field == Field::ry || field == Field::rz;
}
bool is_dh_row(Field field) {
  return field == Field::a || field == Field::alpha || field == Field::d || field == Field::theta;
}

/// The kinds of measurement in the rows of one mounting, and which frame parameters they depend on.
struct MeasuredKinds {
  bool points = false, targets = false, orientations = false, tilts = false;
  bool tool_contact = false;  ///< distances, contacts: they depend on the tool point, but do not determine the base

  bool depends_on(Owner owner, Field field) const {
    const bool turn = is_rotation(field);
    if (owner == Owner::base || owner == Owner::mounting_base) return points || (turn && (orientations || tilts));
    return turn ? orientations || tilts || targets : points || tool_contact;
  }
};

MeasuredKinds measured_in_mounting(const PoseSet& data, int mounting) {
  const auto here = [&](int row) { return data.mounting.empty() ? mounting < 0 : data.mounting[row] == mounting; };
  MeasuredKinds kinds;
  for (const PointMeasurement& m : data.points)
    if (here(m.row)) kinds.points = true, kinds.targets |= m.target >= 0;
  for (const auto& m : data.orientations) kinds.orientations |= here(m.row);
  for (const auto& m : data.tilts) kinds.tilts |= here(m.row);
  for (const auto& m : data.distances) kinds.tool_contact |= here(m.row);
  for (const auto& m : data.contacts) kinds.tool_contact |= here(m.row);
  for (const auto& m : data.pairs) kinds.tool_contact |= here(m.row);
  for (const auto& m : data.plane_contacts) kinds.tool_contact |= here(m.row);
  return kinds;
}

template <class List, class Same>
bool any(const List& list, Same same) {
  return std::any_of(list.begin(), list.end(), same);
}

/// Whether any row refers to that target, anchor, socket or plane, or depends on that frame.
bool is_referenced(const ParameterAddress& at, const PoseSet& data) {
  switch (at.owner) {
    case Owner::base:
    case Owner::tool:
      return measured_in_mounting(data, -1).depends_on(at.owner, at.field);
    case Owner::mounting_base:
    case Owner::mounting_tool:
      return measured_in_mounting(data, at.joint).depends_on(at.owner, at.field);
    case Owner::target:
      return any(data.points, [&](const PointMeasurement& m) { return m.target == at.joint; });
    case Owner::anchor:
      return any(data.distances, [&](const DistanceMeasurement& m) { return m.anchor == at.joint; });
    case Owner::socket:
      return any(data.contacts, [&](const SocketContact& m) { return m.socket == at.joint; });
    case Owner::plane:
      return any(data.plane_contacts, [&](const PlaneContact& m) { return m.plane == at.joint; });
    default:
      return false;
  }
}

/// Hayati's angle beta is needed where the common normal of two axes is ill-defined: alpha near 0 or 180 degrees.
/// Additional branches of a tree need it too: the parameters of the preceding row belong to the first branch.
/// The first MDH row and the last DH row do not need it: the six parameters of the base or of the tool take its place.
bool needs_beta(const Chain& chain, int index) {
  constexpr double nearly_parallel = 5.0 * degree;
  const Joint& joint = chain.joints[index];
  for (int other = 0; other < index && joint.parent >= 0; ++other)
    if (chain.joints[other].parent == joint.parent) return true;
  const auto parallel = [](const DhNumbers& row) { return std::abs(std::sin(row.alpha)) < std::sin(nearly_parallel); };
  if (const auto* mdh = std::get_if<MdhLink>(&joint.link)) return joint.parent >= 0 && parallel(*mdh);
  if (const auto* dh = std::get_if<DhLink>(&joint.link)) return index != chain.tip_joint() && parallel(*dh);
  return false;
}

bool is_geometric(const Chain& chain, const ParameterAddress& at) {
  const Joint& joint = chain.joints[at.joint];
  if (at.field == Field::compliance || at.field == Field::coupling) return false;
  if (at.field == Field::gain) return joint.type == JointType::prismatic && joint.is_active;
  if (std::holds_alternative<UrdfLink>(joint.link)) return joint.type != JointType::fixed;
  return is_dh_row(at.field) || (at.field == Field::beta && needs_beta(chain, at.joint));
}

/// Whether the field is the joint's zero offset.
bool is_offset(const Joint& joint, Field field) {
  if (!joint.is_active || joint.type == JointType::fixed) return false;
  const bool revolute = joint.type == JointType::revolute;
  const auto* urdf = std::get_if<UrdfLink>(&joint.link);
  if (!urdf) return field == (revolute ? Field::theta : Field::d);
  Eigen::Index along;
  urdf->axis.cwiseAbs().maxCoeff(&along);
  constexpr Field turn_about[] = {Field::rx, Field::ry, Field::rz}, shift_along[] = {Field::x, Field::y, Field::z};
  return field == (revolute ? turn_about : shift_along)[along];
}

ParameterSet all_with_fixtures(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = all_parameters(chain, tolerances);
  const ParameterSet is_fixture = setup_parameters(chain, tolerances);
  set.parameters.insert(set.parameters.end(), is_fixture.parameters.begin(), is_fixture.parameters.end());
  return set;
}

template <class Keep>
ParameterSet select_parameters(const Chain& chain, const Tolerances& tolerances, Keep keep) {
  ParameterSet set = all_with_fixtures(chain, tolerances);
  std::erase_if(set.parameters, [&](const Parameter& parameter) { return !keep(parameter); });
  return set;
}

/// Frees the direction of gravity where accelerometers are combined with an external instrument, whose vertical
/// directions differ.
void add_gravity(ParameterSet& set, const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  if (data.tilts.empty() || (data.points.empty() && data.orientations.empty())) return;
  const double prior = chain.gravity.norm() * tolerances.base_angle;
  Eigen::Index down;
  chain.gravity.cwiseAbs().maxCoeff(&down);  // a change along this axis would only scale gravity
  for (const Field field : {Field::x, Field::y, Field::z})
    if (static_cast<Eigen::Index>(field) != down)
      set.parameters.push_back(parameter_at(chain, {Owner::gravity, -1, field}, prior));
}

}  // namespace

ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(
      chain, tolerances, [&](const Parameter& p) { return p.at.owner != Owner::target && is_referenced(p.at, data); });
  for (Parameter& parameter : set.parameters)
    if (parameter.at.owner != Owner::anchor) parameter.prior_sd = std::numeric_limits<double>::infinity();
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(chain, tolerances, [&](const Parameter& p) {
    return p.at.owner == Owner::joint ? is_geometric(chain, p.at) : is_referenced(p.at, data);
  });
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet joint_offset_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  constexpr double collision_angle = 3.0 * degree, collision_length = 10e-3;
  ParameterSet set = select_parameters(chain, tolerances, [&](const Parameter& p) {
    return p.at.owner == Owner::joint ? is_offset(chain.joints[p.at.joint], p.at.field) : is_referenced(p.at, data);
  });
  for (Parameter& parameter : set.parameters)
    if (parameter.at.owner == Owner::joint)
      parameter.scale = parameter.prior_sd =
          parameter.quantity == Quantity::length ? collision_length : collision_angle;
  add_gravity(set, chain, data, tolerances);
  return set;
}

Result<ParameterSet> paper_dh_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(
      chain, tolerances, [](const Parameter& p) { return p.at.owner == Owner::joint && is_dh_row(p.at.field); });
  if (set.parameters.empty()) return error("paper24 needs a robot in DH or MDH form");
  return set;
}

Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names) {
  const ParameterSet all = all_with_fixtures(chain, tolerances);
  for (const std::string& name : names) {
    if (all.find(name)) continue;
    std::string known;
    for (const Parameter& p : all.parameters) known += (known.empty() ? "" : " ") + p.name;
    return error("no parameter is called \"{}\"; this robot has: {}", name, known);
  }
  return select_parameters(chain, tolerances, [&](const Parameter& p) {
    return std::find(names.begin(), names.end(), p.name) != names.end();
  });
}

ParameterSet restricted_to_data(ParameterSet set, const PoseSet& data) {
  std::erase_if(set.parameters, [&](const Parameter& parameter) {
    const Owner owner = parameter.at.owner;
    const bool is_fixture =
        owner == Owner::target || owner == Owner::anchor || owner == Owner::socket || owner == Owner::plane;
    return is_fixture && !is_referenced(parameter.at, data);
  });
  return set;
}

ParameterSet with_prior_means_at(ParameterSet set, const Chain& chain) {
  for (Parameter& parameter : set.parameters) parameter.nominal = value_at(chain, parameter.at);
  return set;
}

}  // namespace kinfer::calibrate
