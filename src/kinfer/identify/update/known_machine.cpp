// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/known_machine.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "kinfer/base/expect.hpp"

namespace kinfer::identify {
namespace {

std::vector<std::string> missing_names(const std::vector<std::string>& wanted, const std::vector<std::string>& there) {
  std::vector<std::string> missing;
  for (const std::string& name : wanted)
    if (std::ranges::find(there, name) == there.end()) missing.push_back(name);
  return missing;
}

/// Indices of the known joints in the order of the tree.
std::vector<std::size_t> joint_order(const SegmentTree& tree, const std::vector<std::string>& segments,
                                     const std::vector<KnownJoint>& joints) {
  std::vector<std::size_t> order;
  for (const std::size_t segment : tree.order) {
    const auto joint = std::ranges::find(joints, segments[segment], &KnownJoint::child);
    if (joint != joints.end()) order.push_back(static_cast<std::size_t>(joint - joints.begin()));
  }
  KINFER_EXPECT(order.size() == joints.size());
  return order;
}

/// Puts the sensors into the order of the segments.
void sort_sensors(TrackingModel& model, const std::vector<std::string>& segments) {
  std::vector<TrackingSensor> sensors;
  std::vector<int> new_index(model.sensors.size());
  for (const std::string& name : segments) {
    const auto sensor = std::ranges::find(model.sensors, name, &TrackingSensor::name);
    KINFER_EXPECT(sensor != model.sensors.end(), "no sensor {}", name);
    new_index[static_cast<std::size_t>(sensor - model.sensors.begin())] = static_cast<int>(sensors.size());
    sensors.push_back(*sensor);
  }
  model.sensors = std::move(sensors);
  for (TrackingBody& body : model.bodies)
    if (body.sensor >= 0) body.sensor = new_index[static_cast<std::size_t>(body.sensor)];
  for (TrackingParameter& parameter : model.parameters)
    if (parameter.kind > TrackingParameterKind::point_in_child)
      parameter.index = new_index[static_cast<std::size_t>(parameter.index)];
}

}  // namespace

std::vector<std::string> sensor_names(const TrackingModel& known) {
  std::vector<std::string> names;
  for (const TrackingSensor& sensor : known.sensors) names.push_back(sensor.name);
  return names;
}

std::string root_sensor(const TrackingModel& known) {
  return known.sensors[static_cast<std::size_t>(known.bodies.front().sensor)].name;
}

std::vector<GivenLink> links_of(const TrackingModel& known) {
  std::vector<GivenLink> links;
  for (const KnownJoint& joint : known_joints(known)) links.push_back({joint.parent, joint.child});
  return links;
}

Result<void> check_sensors(const TrackingModel& known, const InsRecording& log) {
  std::vector<std::string> names;
  for (const InsSensor& sensor : log.sensors) names.push_back(sensor.name);
  const auto missing = missing_names(sensor_names(known), names);
  if (missing.empty()) return {};
  return error("--update: the log has no sensor {} of the chain; it has {}. Is it a log of this machine?",
               fmt::join(missing, ", "), fmt::join(names, ", "));
}

Result<void> check_segments(const TrackingModel& known, const std::vector<std::string>& segments) {
  const auto missing = missing_names(sensor_names(known), segments);
  if (missing.empty()) return {};
  return error(
      "--update: nothing can be said of {} in this log, so the chain was not compared with it; identify "
      "without --update shows why",
      fmt::join(missing, ", "));
}

TrackingModel in_order_of(const SegmentTree& tree, const std::vector<std::string>& segments,
                          const TrackingModel& known) {
  TrackingModel result = known;
  result.joints.clear();
  result.bodies.resize(1);
  std::map<int, int> new_index{{0, 0}};  // of bodies
  for (const std::size_t j : joint_order(tree, segments, known_joints(known))) {
    for (const std::size_t b : bodies_of_joint(known, j)) {
      TrackingBody body = known.bodies[b];
      new_index[static_cast<int>(b)] = static_cast<int>(result.bodies.size());
      body.parent = new_index.at(body.parent);
      body.joint = static_cast<int>(result.joints.size());
      result.bodies.push_back(body);
    }
    TrackingJoint joint = known.joints[j];
    joint.first_position = result.positions();
    result.joints.push_back(std::move(joint));
  }
  sort_sensors(result, segments);
  for (TrackingSensor& sensor : result.sensors) sensor.body = new_index.at(sensor.body);
  for (TrackingParameter& parameter : result.parameters)
    if (parameter.kind <= TrackingParameterKind::point_in_child) parameter.index = new_index.at(parameter.index);
  result.tool.body = new_index.at(result.tool.body);
  expect_well_formed(result);
  return result;
}

RefinedJoint as_refined(const KnownJoint& joint, const TrackingModel& model) {
  const MatrixXd covariance = model.covariance(joint.parameters, joint.parameters);
  const PositiveAxis own{joint.bodies.front().parent_R_axis.col(2), joint.bodies.back().child_R_axis.col(2)};
  RefinedJoint result = refined_joint(joint.type, joint.bodies, joint.zero, covariance, joint.spherical_axes, own);
  result.estimate.parent = joint.parent;
  result.estimate.child = joint.child;
  return result;
}

std::vector<JointResult> known_results(const TrackingModel& known) {
  std::vector<JointResult> results;
  for (const KnownJoint& joint : known_joints(known)) {
    const RefinedJoint refined = as_refined(joint, known);
    results.push_back({.joint = refined.estimate, .dh = canonical_dh_rows(refined.estimate, refined.solution)});
  }
  return results;
}

}  // namespace kinfer::identify
