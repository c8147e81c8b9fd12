// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/machine_from_chain.hpp"

#include <algorithm>

namespace kinfer {
namespace {

/// "A" of a joint "A-B" that leads to the sensor "B"; empty for any other joint.
std::string parent_sensor_name(const std::string& joint, const std::string& sensor) {
  return joint.size() > sensor.size() + 1 && joint.ends_with("-" + sensor)
             ? joint.substr(0, joint.size() - sensor.size() - 1)
             : "";
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
  return machine;
}

}  // namespace kinfer
