// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/simulation_files.hpp"
#include "kinfer/io/text/dump_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace kinfer::cli {
namespace {

using Json = nlohmann::ordered_json;

void append_cell(std::string& text, float value) {
  text += ',';
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(text), "{}", value);
}

Json json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json(const std::vector<Vec3>& vectors) {
  Json list = Json::array();
  for (const Vec3& v : vectors) list.push_back(json(v));
  return list;
}

Json words(const JointTruth& joint) {
  Json list = Json::array();
  if (translates(joint.type)) list.push_back("the place of a slide's axis across itself: only its direction matters");
  if (joint.unobservable_in_parent.size() == 3)
    list.push_back("the joint's place in " + joint.parent + ", which stands still");
  if (joint.unobservable_in_parent.size() == 1)
    list.push_back("the joint's place in " + joint.parent + " along the one axis about which that sensor turns");
  if (joint.unobservable_in_child.size() == 1)
    list.push_back("the joint's place in " + joint.child + " along the one axis about which that sensor turns");
  if (joint.heading_needs_magnetometer) list.push_back("the azimuth of " + joint.child + ", without its magnetometer");
  return list;
}

Json json(const JointTruth& joint) {
  return {{"name", joint.name},
          {"parent", joint.parent},
          {"child", joint.child},
          {"type", traits(joint.type).name},
          {"axis_in_parent", json(joint.axis_in_parent)},
          {"point_in_parent", json(joint.point_in_parent)},
          {"axis_in_child", json(joint.axis_in_child)},
          {"point_in_child", json(joint.point_in_child)},
          {"not_identifiable", words(joint)},
          {"not_identifiable_in_parent", json(joint.unobservable_in_parent)},
          {"not_identifiable_in_child", json(joint.unobservable_in_child)},
          {"slide_observable", joint.is_axial_offset_observable},
          {"azimuth_by_magnetometer_only", joint.heading_needs_magnetometer}};
}

}  // namespace

std::string imu_csv(const InsRecording& recording) {
  std::string text = "t";
  for (const InsSensor& sensor : recording.sensors)
    for (const char* channel : {"ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"})
      if (channel[0] != 'm' || sensor.has_magnetometer()) text += fmt::format(",{}_{}", sensor.name, channel);
  text += '\n';
  const std::vector<double>& time = recording.loggers.front().time;
  for (std::size_t row = 0; row < time.size(); ++row) {
    fmt::format_to(std::back_inserter(text), "{}", time[row]);
    for (const InsSensor& sensor : recording.sensors)
      for (const TriadColumns* columns : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
        if (columns->present())
          for (const auto& axis : columns->axis) append_cell(text, axis[row]);
    text += '\n';
  }
  return text;
}

std::string motion_csv(const Machine& machine, const MachineMotion& motion) {
  std::string text = "t";
  for (const std::string& name : active_joint_names(machine.chain)) text += ",q_" + name;
  for (const MountedSensor& sensor : machine.sensors) text += fmt::format(",{0}_qw,{0}_qx,{0}_qy,{0}_qz", sensor.name);
  text += '\n';
  for (std::size_t row = 0; row < motion.time.size(); ++row) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{}", motion.time[row]);
    for (double q : motion.q.col(static_cast<Eigen::Index>(row))) fmt::format_to(out, ",{:.12g}", q);
    for (const SensorMotion& sensor : motion.sensors) {
      const Quat& r = sensor.world_R_sensor[row];
      fmt::format_to(out, ",{:.12g},{:.12g},{:.12g},{:.12g}", r.w(), r.x(), r.y(), r.z());
    }
    text += '\n';
  }
  return text;
}

std::string truth_json(const SimulationRecord& record, const Drive& drive, const Machine& machine,
                       const MachineTruth& truth) {
  Json document{{"format", "kinfer-truth/1"},
                {"machine", record.machine},
                {"grade", record.grade},
                {"base", record.base},
                {"slope_deg", record.slope_deg},
                {"seed", record.seed},
                {"drive", record.drive},
                {"sampling_rate", record.sampling_rate},
                {"root", truth.root}};
  document["gravity"] = json(machine.chain.gravity);
  document["magnetic_field"] = json(magnetic_field_world);
  document["joints"] = Json::array();
  for (const JointTruth& joint : truth.joints) document["joints"].push_back(json(joint));
  document["loops"] = Json::array();
  for (const JointTruth& loop : truth.loops)
    document["loops"].push_back({{"name", loop.name},
                                 {"first", loop.parent},
                                 {"second", loop.child},
                                 {"axis_in_first", json(loop.axis_in_parent)},
                                 {"point_in_first", json(loop.point_in_parent)},
                                 {"axis_in_second", json(loop.axis_in_child)},
                                 {"point_in_second", json(loop.point_in_child)}});
  document["links"] = Json::array();
  for (const LinkTruth& link : truth.links) {
    Json entry{{"segment", link.segment},
               {"from", link.from},
               {"to", link.to},
               {"length_m", link.length},
               {"axis_angle_rad", link.axis_angle}};
    if (link.pin_distance) entry["pin_distance_m"] = *link.pin_distance;
    document["links"].push_back(entry);
  }
  document["schedule"] = Json::array();
  for (const Phase& phase : drive.phases)
    document["schedule"].push_back({{"what", phase.what}, {"begin", phase.begin}, {"end", phase.end}});
  return dump_json(document, 1) + "\n";
}

}  // namespace kinfer::cli
