// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/parameters/parameter_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer::calibrate {
namespace {

bool is_dh_row(Field field) {
  return field == Field::a || field == Field::alpha || field == Field::d || field == Field::theta;
}

/// What the measurements observe in the rows whose mounting is accepted.
template <class Accepts>
Observes observed_in_mountings(const PoseSet& data, Accepts accepts) {
  const auto here = [&](int row) { return accepts(data.mounting.empty() ? -1 : data.mounting[row]); };
  Observes sum;
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if (std::none_of(list.begin(), list.end(), [&](const M& m) { return here(m.row); })) return;
    constexpr Observes observes = M::traits.observes;
    sum.base_position |= observes.base_position, sum.base_rotation |= observes.base_rotation;
    sum.tool_position |= observes.tool_position, sum.tool_rotation |= observes.tool_rotation;
  });
  sum.tool_rotation |= std::any_of(data.points.begin(), data.points.end(),
                                   [&](const PointMeasurement& m) { return m.target >= 0 && here(m.row); });
  return sum;
}

/// The mounting whose base a row of this mounting stands on; −1: the chain's own.
int mounting_of_base(const Chain& chain, int mounting) {
  const bool own = mounting >= 0 && chain.mountings[static_cast<std::size_t>(mounting)].base;
  return own ? mounting : -1;
}

bool is_observed(const FrameNumber& number, const Chain& chain, const PoseSet& data) {
  const bool turn = is_rotation(number.field);
  if (number.frame == SetupFrame::base) {
    const Observes observed =
        observed_in_mountings(data, [&](int mounting) { return mounting_of_base(chain, mounting) == number.mounting; });
    return turn ? observed.base_rotation : observed.base_position;
  }
  const Observes observed = observed_in_mountings(data, [&](int mounting) { return mounting == number.mounting; });
  return turn ? observed.tool_rotation : observed.tool_position;
}

bool refers_to(const PoseMeasurements& data, FixtureKind kind, int fixture) {
  bool found = false;
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if constexpr (RefersToFixture<M>)
      if (fixture_kind(M::traits.fixture) == kind)
        found |= std::any_of(list.begin(), list.end(), [&](const M& m) { return m.*M::fixture_index == fixture; });
  });
  return found;
}

/// Whether any row refers to that target or fixture.
bool is_object_referenced(const ParameterAddress& at, const PoseSet& data) {
  if (const auto* fixture = std::get_if<FixtureNumber>(&at)) return refers_to(data, fixture->kind, fixture->index);
  const auto* target = std::get_if<TargetNumber>(&at);
  return target && std::any_of(data.points.begin(), data.points.end(),
                               [&](const PointMeasurement& m) { return m.target == target->target; });
}

/// The same, or depends on that frame.
bool is_referenced(const ParameterAddress& at, const Chain& chain, const PoseSet& data) {
  const auto* frame = std::get_if<FrameNumber>(&at);
  return frame ? is_observed(*frame, chain, data) : is_object_referenced(at, data);
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

bool is_geometric(const Chain& chain, const JointNumber& at) {
  const Joint& joint = chain.joints[at.joint];
  if (at.field == Field::compliance || at.field == Field::coupling) return false;
  if (at.field == Field::gain) return translates(joint.type) && joint.is_active;
  if (std::holds_alternative<UrdfLink>(joint.link)) return has_position(joint.type);
  return is_dh_row(at.field) || (at.field == Field::beta && needs_beta(chain, at.joint));
}

/// Whether the field is the joint's zero offset.
bool is_offset(const Joint& joint, Field field) {
  if (!joint.is_active || !has_position(joint.type)) return false;
  const bool revolute = rotates(joint.type);
  const auto* urdf = std::get_if<UrdfLink>(&joint.link);
  if (!urdf) return field == (revolute ? Field::theta : Field::d);
  Eigen::Index along;
  urdf->axis.cwiseAbs().maxCoeff(&along);
  constexpr Field turn_about[] = {Field::rx, Field::ry, Field::rz}, shift_along[] = {Field::x, Field::y, Field::z};
  return field == (revolute ? turn_about : shift_along)[along];
}

ParameterSet all_with_fixtures(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = all_parameters(chain, tolerances);
  const ParameterSet setup = setup_parameters(chain, tolerances);
  set.parameters.insert(set.parameters.end(), setup.parameters.begin(), setup.parameters.end());
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
      set.parameters.push_back(parameter_at(chain, GravityNumber{field}, prior));
}

}  // namespace

ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(chain, tolerances, [&](const Parameter& p) {
    return !std::holds_alternative<TargetNumber>(p.at) && is_referenced(p.at, chain, data);
  });
  for (Parameter& parameter : set.parameters)
    if (!std::holds_alternative<FixtureNumber>(parameter.at))
      parameter.prior_sd = std::numeric_limits<double>::infinity();
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(chain, tolerances, [&](const Parameter& p) {
    const JointNumber* number = joint_number(p.at);
    return number ? is_geometric(chain, *number) : is_referenced(p.at, chain, data);
  });
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet joint_offset_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  constexpr double collision_angle = 3.0 * degree, collision_length = 10e-3;
  ParameterSet set = select_parameters(chain, tolerances, [&](const Parameter& p) {
    const JointNumber* number = joint_number(p.at);
    return number ? is_offset(chain.joints[number->joint], number->field) : is_referenced(p.at, chain, data);
  });
  for (Parameter& parameter : set.parameters)
    if (is_joint_parameter(parameter.at))
      parameter.scale = parameter.prior_sd =
          parameter.quantity == Quantity::length ? collision_length : collision_angle;
  add_gravity(set, chain, data, tolerances);
  return set;
}

Result<ParameterSet> paper_dh_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = select_parameters(
      chain, tolerances, [](const Parameter& p) { return is_joint_parameter(p.at) && is_dh_row(*field_of(p.at)); });
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
    return is_object_parameter(parameter.at) && !is_object_referenced(parameter.at, data);
  });
  return set;
}

ParameterSet with_prior_means_at(ParameterSet set, const Chain& chain) {
  for (Parameter& parameter : set.parameters) parameter.nominal = value_at(chain, parameter.at);
  return set;
}

}  // namespace kinfer::calibrate
