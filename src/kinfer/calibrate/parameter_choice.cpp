#include "kinfer/calibrate/parameter_choice.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

bool is_turn(Field field) {
  return field == Field::rx || field == Field::ry || field == Field::rz;
}
bool is_dh_row(Field field) {
  return field == Field::a || field == Field::alpha || field == Field::d || field == Field::theta;
}

bool tool_parameter_is_used(Field field, const PoseSet& data) {
  const bool further_targets = std::any_of(data.points.begin(), data.points.end(),
                                           [](const PointMeasurement& point) { return point.target >= 0; });
  return !is_turn(field) || !data.orientations.empty() || further_targets;
}

/// Hayati's angle is needed where the common perpendicular of two axes is ill defined: alpha near 0 or 180 degrees.
/// Beside the base (first MDH row) and the tool (last DH row) a frame of six numbers takes its place.
bool beta_is_needed(const Chain& chain, int index) {
  constexpr double nearly_parallel = 5.0 * degree;
  const Joint& joint = chain.joints[index];
  const auto parallel = [](const DhNumbers& row) { return std::abs(std::sin(row.alpha)) < std::sin(nearly_parallel); };
  if (const auto* mdh = std::get_if<MdhLink>(&joint.link)) return joint.parent >= 0 && parallel(*mdh);
  if (const auto* dh = std::get_if<DhLink>(&joint.link)) return index != chain.tip_joint() && parallel(*dh);
  return false;
}

bool joint_parameter_is_geometric(const Chain& chain, const Address& at) {
  const Joint& joint = chain.joints[at.joint];
  if (at.field == Field::compliance) return false;
  if (at.field == Field::gain) return joint.type == JointType::prismatic && joint.has_reading;
  if (std::holds_alternative<UrdfLink>(joint.link)) return joint.type != JointType::fixed;
  return is_dh_row(at.field) || (at.field == Field::beta && beta_is_needed(chain, at.joint));
}

template <class Keep>
ParameterSet chosen(const Chain& chain, const Tolerances& tolerances, Keep keep) {
  ParameterSet set = all_parameters(chain, tolerances);
  std::erase_if(set.parameters, [&](const Parameter& parameter) { return !keep(parameter); });
  return set;
}

}  // namespace

ParameterSet frame_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  return chosen(chain, tolerances, [&](const Parameter& p) {
    return p.at.owner == Owner::base || (p.at.owner == Owner::tool && tool_parameter_is_used(p.at.field, data));
  });
}

ParameterSet geometric_parameters(const Chain& chain, const PoseSet& data, const Tolerances& tolerances) {
  return chosen(chain, tolerances, [&](const Parameter& p) {
    switch (p.at.owner) {
      case Owner::base:
        return true;
      case Owner::tool:
        return tool_parameter_is_used(p.at.field, data);
      case Owner::joint:
        return joint_parameter_is_geometric(chain, p.at);
    }
    return false;
  });
}

Result<ParameterSet> paper24_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set =
      chosen(chain, tolerances, [](const Parameter& p) { return p.at.owner == Owner::joint && is_dh_row(p.at.field); });
  if (set.parameters.empty()) return error("paper24 needs a robot in DH or MDH form");
  return set;
}

Result<ParameterSet> named_parameters(const Chain& chain, const Tolerances& tolerances,
                                      const std::vector<std::string>& names) {
  const ParameterSet all = all_parameters(chain, tolerances);
  for (const std::string& name : names) {
    if (all.find(name)) continue;
    std::string known;
    for (const Parameter& p : all.parameters) known += (known.empty() ? "" : " ") + p.name;
    return error("no parameter is called \"{}\"; this robot has: {}", name, known);
  }
  return chosen(chain, tolerances,
                [&](const Parameter& p) { return std::find(names.begin(), names.end(), p.name) != names.end(); });
}

ParameterSet centred_at(ParameterSet set, const Chain& chain) {
  for (Parameter& parameter : set.parameters) parameter.nominal = value_at(chain, parameter.at);
  return set;
}

}  // namespace kinfer
