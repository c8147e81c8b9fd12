// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/geometry/identified_chain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer::identify {
namespace {

/// Index of the joint whose frame is the sensor's; −1: the base.
int frame_of(const Chain& chain, const std::string& root, const std::string& sensor) {
  const auto found = std::ranges::find(chain.joints, sensor, &Joint::name);
  return sensor == root || found == chain.joints.end() ? -1 : static_cast<int>(found - chain.joints.begin());
}

}  // namespace

JointEstimate joint_estimate(const std::string& parent, const std::string& child, const GeometryEstimate& estimate) {
  JointEstimate joint{.parent = parent, .child = child};
  joint.axis_in_parent = estimate.geometry.axis_in_parent;
  joint.axis_in_child = estimate.geometry.axis_in_child;
  joint.point_in_parent = estimate.geometry.point_in_parent;
  joint.point_in_child = estimate.geometry.point_in_child;
  joint.sd = estimate.precision.sd;
  joint.unobservable_in_parent = estimate.precision.unobservable_in_parent;
  joint.unobservable_in_child = estimate.precision.unobservable_in_child;
  return joint;
}

std::vector<DhRowEstimate> leaf_dh_rows(const std::string& segment, std::span<const DhLeaf> leaves,
                                        std::span<const JointSignal> signals) {
  const auto name = [&](int signal) {
    return signal == DhLeaf::constant ? "" : signals[static_cast<std::size_t>(signal)].name;
  };
  std::vector<DhRowEstimate> rows;
  for (const DhLeaf& leaf : leaves)
    rows.push_back({.segment = segment,
                    .row = {.a = leaf.a, .alpha = leaf.alpha, .d = leaf.d, .theta = leaf.theta},
                    .sd = {},
                    .theta_variable = name(leaf.theta_signal),
                    .alpha_variable = name(leaf.alpha_signal)});
  return rows;
}

std::vector<Vec3> joint_axes(EstimatedJointType type, const JointGeometry& geometry) {
  if (type == EstimatedJointType::universal)
    return {geometry.axis_in_parent, geometry.home.rotation * geometry.axis_in_child};
  if (type == EstimatedJointType::spherical)
    return {geometry.spherical_axes.col(0), geometry.spherical_axes.col(1), geometry.spherical_axes.col(2)};
  return {geometry.axis_in_parent};
}

std::vector<DhNumbers> joint_dh_rows(EstimatedJointType type, const JointGeometry& geometry) {
  return dh_rows_through(geometry.point_in_parent, joint_axes(type, geometry), geometry.home);
}

std::vector<DhRowEstimate> canonical_dh_rows(const JointEstimate& joint, const GeometryEstimate& estimate) {
  const std::vector<DhNumbers> numbers = joint_dh_rows(joint.type, estimate.geometry);
  const std::vector<DhNumbers>& sd = estimate.precision.canonical_sd;
  const std::size_t axes = numbers.size() - 2;
  const auto variable = [&](std::size_t row) {
    if (joint.type == EstimatedJointType::rigid || row == 0 || row > axes) return std::string();
    return axes == 1 ? joint_name(joint) : fmt::format("{} {}", joint_name(joint), row);
  };
  const bool is_prismatic = joint.type == EstimatedJointType::prismatic;
  std::vector<DhRowEstimate> rows;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    rows.push_back({.segment = joint.child,
                    .row = numbers[i],
                    .sd = i < sd.size() ? sd[i] : DhNumbers{},
                    .theta_variable = is_prismatic ? "" : variable(i),
                    .alpha_variable = "",
                    .d_variable = is_prismatic ? variable(i) : ""});
  return rows;
}

Chain build_chain(const std::string& root, const std::vector<JointEstimate>& joints,
                  const std::vector<DhRowEstimate>& dh, const Mat3& world_R_root) {
  Chain chain;
  chain.name = "identified";
  chain.base.rotation = world_R_root;
  auto row = dh.begin();
  for (const JointEstimate& found : joints) {
    const auto first = row, last = std::find_if(row, dh.end(), [&](const auto&r) { return r.segment != found.child; });
    KINFER_EXPECT(last - first >= 3, "{} rows lead to {}", last - first, found.child);
    for (; row != last; ++row) {
      Joint joint{.name = row == first ? joint_name(found) + " axis" : row->variable()};
      if (joint.name.empty()) joint.name = row + 1 == last ? found.child : joint_name(found);
      joint.parent = row == first ? frame_of(chain, root, found.parent) : static_cast<int>(chain.joints.size()) - 1;
      joint.is_active = !row->variable().empty();
      joint.type = !joint.is_active           ? JointType::fixed
                   : !row->d_variable.empty() ? JointType::prismatic
                                              : JointType::revolute;
      joint.link = DhLink{row->row};
      chain.joints.push_back(joint);
    }
  }
  KINFER_EXPECT(row == dh.end(), "rows of no joint");
  return chain;
}

void set_closures(Chain& chain, const std::string& root, const std::vector<LoopEstimate>& loops) {
  for (const LoopEstimate& loop : loops) {
    const JointEstimate& joint = loop.joint;
    chain.closures.push_back({.name = joint_name(joint),
                              .first = frame_of(chain, root, joint.parent),
                              .second = frame_of(chain, root, joint.child),
                              .point_in_first = joint.point_in_parent,
                              .point_in_second = joint.point_in_child,
                              .axis_in_first = joint.axis_in_parent,
                              .axis_in_second = joint.axis_in_child});
  }
}

void set_tool(Chain& chain, const std::vector<PointEstimate>& places) {
  const auto is_tool = [&](const PointEstimate& place) {
    return place.name == "tip" || place.name == "tool" || places.size() == 1;
  };
  const auto tool = std::ranges::find_if(places, is_tool);
  if (tool == places.end()) return;
  const auto flange = std::ranges::find(chain.joints, tool->sensor, &Joint::name);
  if (flange == chain.joints.end()) return;
  chain.tip = static_cast<int>(flange - chain.joints.begin());
  chain.tool.xyz = tool->xyz;
}

}  // namespace kinfer::identify
