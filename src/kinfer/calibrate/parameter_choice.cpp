#include "kinfer/calibrate/parameter_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer {
namespace {

bool is_small_turn(Field field) {
  return field == Field::rx || field == Field::ry || field == Field::rz;
}
bool is_dh_row(Field field) {
  return field == Field::a || field == Field::alpha || field == Field::d || field == Field::theta;
}

/// What the rows of one mounting say about its frames.
struct Told {
  bool points = false, targets = false, orientations = false, tilts = false;
  bool touches = false;  ///< distances, contacts: they see the tool point, but not where the base stands

  bool uses(Owner owner, Field field) const {
    const bool turn = is_small_turn(field);
    if (owner == Owner::base || owner == Owner::mounting_base) return points || (turn && (orientations || tilts));
    return turn ? orientations || tilts || targets : points || touches;
  }
};

Told told_about(const PoseSet& data, int mounting) {
  const auto here = [&](int row) { return data.mounting.empty() ? mounting < 0 : data.mounting[row] == mounting; };
  Told told;
  for (const PointMeasurement& m : data.points)
    if (here(m.row)) told.points = true, told.targets |= m.target >= 0;
  for (const auto& m : data.orientations) told.orientations |= here(m.row);
  for (const auto& m : data.tilts) told.tilts |= here(m.row);
  for (const auto& m : data.distances) told.touches |= here(m.row);
  for (const auto& m : data.contacts) told.touches |= here(m.row);
  for (const auto& m : data.pairs) told.touches |= here(m.row);
  for (const auto& m : data.plane_contacts) told.touches |= here(m.row);
  return told;
}

template <class List, class Same>
bool any(const List& list, Same same) {
  return std::any_of(list.begin(), list.end(), same);
}

/// Whether some row refers to that target, anchor, socket or plane, or sees that frame.
bool is_seen(const Address& at, const PoseSet& data) {
  switch (at.owner) {
    case Owner::base:
    case Owner::tool:
      return told_about(data, -1).uses(at.owner, at.field);
    case Owner::mounting_base:
    case Owner::mounting_tool:
      return told_about(data, at.joint).uses(at.owner, at.field);
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

/// Hayati's angle is needed where the common perpendicular of two axes is ill defined: alpha near 0 or 180 degrees.
/// A further branch of a tree needs it too: the numbers of the row before are those of the first branch.
/// Beside the base (first MDH row) and the tool (last DH row) a frame of six numbers takes its place.
bool beta_is_needed(const Chain& chain, int index) {
  constexpr double nearly_parallel = 5.0 * degree;
  const Joint& joint = chain.joints[index];
  for (int other = 0; other < index && joint.parent >= 0; ++other)
    if (chain.joints[other].parent == joint.parent) return true;
  const auto parallel = [](const DhNumbers& row) { return std::abs(std::sin(row.alpha)) < std::sin(nearly_parallel); };
  if (const auto* mdh = std::get_if<MdhLink>(&joint.link)) return joint.parent >= 0 && parallel(*mdh);
  if (const auto* dh = std::get_if<DhLink>(&joint.link)) return index != chain.tip_joint() && parallel(*dh);
  return false;
}

bool joint_parameter_is_geometric(const Chain& chain, const Address& at) {
  const Joint& joint = chain.joints[at.joint];
  if (at.field == Field::compliance || at.field == Field::coupling) return false;
  if (at.field == Field::gain) return joint.type == JointType::prismatic && joint.has_reading;
  if (std::holds_alternative<UrdfLink>(joint.link)) return joint.type != JointType::fixed;
  return is_dh_row(at.field) || (at.field == Field::beta && beta_is_needed(chain, at.joint));
}

/// Whether the field is where the joint's own movement starts from.
bool is_offset(const Joint& joint, Field field) {
  if (!joint.has_reading || joint.type == JointType::fixed) return false;
  const bool turns = joint.type == JointType::revolute;
  const auto* urdf = std::get_if<UrdfLink>(&joint.link);
  if (!urdf) return field == (turns ? Field::theta : Field::d);
  Eigen::Index along;
  urdf->axis.cwiseAbs().maxCoeff(&along);
  constexpr Field turn_about[] = {Field::rx, Field::ry, Field::rz}, shift_along[] = {Field::x, Field::y, Field::z};
  return field == (turns ? turn_about : shift_along)[along];
}

ParameterSet everything(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = all_parameters(chain, tolerances);
  const ParameterSet around = surroundings_parameters(chain, tolerances);
  set.parameters.insert(set.parameters.end(), around.parameters.begin(), around.parameters.end());
  return set;
}

template <class Keep>
ParameterSet chosen(const Chain& chain, const Tolerances& tolerances, Keep keep) {
  ParameterSet set = everything(chain, tolerances);
  std::erase_if(set.parameters, [&](const Parameter& parameter) { return !keep(parameter); });
  return set;
}

/// Accelerometers and an outside instrument hardly agree by themselves on what is up.
void add_gravity(ParameterSet& set, const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  if (data.tilts.empty() || (data.points.empty() && data.orientations.empty())) return;
  const double prior = chain.gravity.norm() * tolerances.base_angle;
  Eigen::Index down;
  chain.gravity.cwiseAbs().maxCoeff(&down);  // along it, a change would only scale
  for (const Field field : {Field::x, Field::y, Field::z})
    if (static_cast<Eigen::Index>(field) != down)
      set.parameters.push_back(parameter_at(chain, {Owner::gravity, -1, field}, prior));
}

}  // namespace

ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set =
      chosen(chain, tolerances, [&](const Parameter& p) { return p.at.owner != Owner::target && is_seen(p.at, data); });
  for (Parameter& parameter : set.parameters)
    if (parameter.at.owner != Owner::anchor) parameter.prior_sd = std::numeric_limits<double>::infinity();
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  ParameterSet set = chosen(chain, tolerances, [&](const Parameter& p) {
    return p.at.owner == Owner::joint ? joint_parameter_is_geometric(chain, p.at) : is_seen(p.at, data);
  });
  add_gravity(set, chain, data, tolerances);
  return set;
}

ParameterSet offset_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  constexpr double knock_angle = 3.0 * degree, knock_length = 10e-3;
  ParameterSet set = chosen(chain, tolerances, [&](const Parameter& p) {
    return p.at.owner == Owner::joint ? is_offset(chain.joints[p.at.joint], p.at.field) : is_seen(p.at, data);
  });
  for (Parameter& parameter : set.parameters)
    if (parameter.at.owner == Owner::joint)
      parameter.scale = parameter.prior_sd = parameter.quantity == Quantity::length ? knock_length : knock_angle;
  add_gravity(set, chain, data, tolerances);
  return set;
}

Result<ParameterSet> paper24_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set =
      chosen(chain, tolerances, [](const Parameter& p) { return p.at.owner == Owner::joint && is_dh_row(p.at.field); });
  if (set.parameters.empty()) return error("paper24 needs a robot in DH or MDH form");
  return set;
}

Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names) {
  const ParameterSet all = everything(chain, tolerances);
  for (const std::string& name : names) {
    if (all.find(name)) continue;
    std::string known;
    for (const Parameter& p : all.parameters) known += (known.empty() ? "" : " ") + p.name;
    return error("no parameter is called \"{}\"; this robot has: {}", name, known);
  }
  return chosen(chain, tolerances,
                [&](const Parameter& p) { return std::find(names.begin(), names.end(), p.name) != names.end(); });
}

ParameterSet seen_in(ParameterSet set, const PoseSet& data) {
  std::erase_if(set.parameters, [&](const Parameter& parameter) {
    const Owner owner = parameter.at.owner;
    const bool around =
        owner == Owner::target || owner == Owner::anchor || owner == Owner::socket || owner == Owner::plane;
    return around && !is_seen(parameter.at, data);
  });
  return set;
}

ParameterSet centred_at(ParameterSet set, const Chain& chain) {
  for (Parameter& parameter : set.parameters) parameter.nominal = value_at(chain, parameter.at);
  return set;
}

}  // namespace kinfer
