// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/machine_from_chain.hpp"

#include <algorithm>
#include <string_view>

namespace kinfer {
namespace {

/// "A-B" of a joint position "A-B 2": a universal joint has two, a spherical one three.
std::string_view joint_of_position(std::string_view position) {
  const bool is_numbered =
      position.size() > 2 && position[position.size() - 2] == ' ' && position.back() >= '1' && position.back() <= '3';
  return is_numbered ? position.substr(0, position.size() - 2) : position;
}

/// "A" of a joint "A-B" that leads to the sensor "B"; empty for any other joint.
std::string parent_in_name(std::string_view joint, const std::string& sensor) {
  return joint.size() > sensor.size() + 1 && joint.ends_with("-" + sensor)
             ? std::string(joint.substr(0, joint.size() - sensor.size() - 1))
             : "";
}

/// The same of a joint or of its last position.
std::string parent_sensor_name(const std::string& last, const std::string& sensor) {
  const std::string parent = parent_in_name(last, sensor);  // first: a sensor's own name may end with a number
  return parent.empty() ? parent_in_name(joint_of_position(last), sensor) : parent;
}

/// A joint that moves and that no sensor shows would be left out without a word.
Result<void> check_every_joint_leads_to_a_sensor(const Machine& machine) {
  const auto leads_to = [&](const Joint& joint, const MountedSensor& sensor) {
    return !parent_sensor_name(joint.name, sensor.name).empty();
  };
  for (const Joint& joint : machine.chain.joints)
    if (has_position(joint.type) &&
        std::ranges::none_of(machine.sensors, [&](const MountedSensor& sensor) { return leads_to(joint, sensor); }))
      return error("joint {}: it leads to no sensor; expected a chain written by identify", joint.name);
  return {};
}

}  // namespace

Result<Machine> make_machine(const Chain& chain) {
  Machine machine;
  machine.chain = chain;
  machine.chain.joints.insert(machine.chain.joints.begin(),
                              {.name = "root", .type = JointType::fixed, .link = UrdfLink{}, .is_active = false});
  for (std::size_t j = 1; j < machine.chain.joints.size(); ++j) ++machine.chain.joints[j].parent;
  machine.chain.tip = machine.chain.tip >= 0 ? machine.chain.tip + 1 : -1;
  machine.home = VectorXd::Zero(dof(machine.chain));
  for (std::size_t j = 2; j < machine.chain.joints.size(); ++j) {
    const Joint& frame = machine.chain.joints[j];
    if (has_position(frame.type)) continue;
    const std::string parent =
        parent_sensor_name(machine.chain.joints[static_cast<std::size_t>(frame.parent)].name, frame.name);
    if (parent.empty()) continue;
    if (machine.sensors.empty())
      machine.sensors.push_back({.name = parent, .segment = parent, .joint = 0, .parent = -1, .segment_T_sensor = {}});
    const auto carrier = std::ranges::find(machine.sensors, parent, &MountedSensor::name);
    if (carrier == machine.sensors.end())
      return error("joint {}-{}: sensor {} does not precede it in the chain", parent, frame.name, parent);
    machine.sensors.push_back({.name = frame.name,
                               .segment = frame.name,
                               .joint = static_cast<int>(j),
                               .parent = static_cast<int>(carrier - machine.sensors.begin()),
                               .segment_T_sensor = {}});
  }
  if (machine.sensors.size() < 2) return error("the chain contains no sensors; expected a chain written by identify");
  if (auto checked = check_every_joint_leads_to_a_sensor(machine); !checked) return forward_error(checked.error());
  return machine;
}

}  // namespace kinfer
