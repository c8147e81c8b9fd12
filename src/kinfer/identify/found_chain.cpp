#include "kinfer/identify/found_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

std::string joint_name(const FoundJoint& joint) {
  return joint.parent + "-" + joint.child;
}

/// Distance of two lines, its points nearest to each other.
double distance_of_lines(const Vec3& point_a, const Vec3& axis_a, const Vec3& point_b, const Vec3& axis_b) {
  constexpr double parallel = 1e-3;  // sine below which the lines count as parallel
  const Vec3 across = axis_a.cross(axis_b), between = point_b - point_a;
  if (across.norm() < parallel) return (between - axis_a.dot(between) * axis_a).norm();
  return std::abs(between.dot(across.normalized()));
}

double across(const std::array<double, 2>& sd) {
  return std::hypot(sd[0], sd[1]) / std::sqrt(2.0);
}

void say_what_is_hidden(FoundJoint& joint) {
  const auto say = [&](std::size_t count, const std::string& sensor) {
    if (count == 3)
      joint.not_identifiable.push_back(
          fmt::format("where the axis is in {}, which only stands or shifts without turning", sensor));
    else if (count > 0)
      joint.not_identifiable.push_back(
          fmt::format("shifts of the axis in {} along what its sensor turns about alone", sensor));
  };
  say(joint.not_identifiable_in_parent.size(), joint.parent);
  say(joint.not_identifiable_in_child.size(), joint.child);
  joint.not_identifiable.emplace_back("the joint's point along its own axis");
}

}  // namespace

FoundJoint found_joint(const std::string& parent, const std::string& child, const FoundHinge& hinge) {
  FoundJoint joint{.parent = parent, .child = child};
  joint.axis_in_parent = hinge.geometry.axis_in_parent;
  joint.axis_in_child = hinge.geometry.axis_in_child;
  joint.point_in_parent = hinge.geometry.point_in_parent;
  joint.point_in_child = hinge.geometry.point_in_child;
  joint.sd = hinge.precision.sd;
  joint.not_identifiable_in_parent = hinge.precision.hidden_in_parent;
  joint.not_identifiable_in_child = hinge.precision.hidden_in_child;
  say_what_is_hidden(joint);
  return joint;
}

std::vector<FoundDhRow> found_rows(const std::string& segment, std::span<const DhLeaf> leaves,
                                   std::span<const JointSignal> signals) {
  const auto name = [&](int signal) {
    return signal == DhLeaf::constant ? "" : signals[static_cast<std::size_t>(signal)].name;
  };
  std::vector<FoundDhRow> rows;
  for (const DhLeaf& leaf : leaves)
    rows.push_back({.segment = segment,
                    .row = {.a = leaf.a, .alpha = leaf.alpha, .d = leaf.d, .theta = leaf.theta},
                    .sd = {},
                    .theta_variable = name(leaf.theta_signal),
                    .alpha_variable = name(leaf.alpha_signal)});
  return rows;
}

std::vector<FoundDhRow> canonical_rows(const FoundJoint& joint, const FoundHinge& hinge) {
  const auto numbers = canonical_rows(hinge.geometry);
  std::vector<FoundDhRow> rows;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    rows.push_back({.segment = joint.child,
                    .row = numbers[i],
                    .sd = hinge.precision.canonical_sd[i],
                    .theta_variable = i == 1 ? joint_name(joint) : "",
                    .alpha_variable = ""});
  return rows;
}

std::vector<FoundLink> found_links(const std::vector<FoundJoint>& joints) {
  std::vector<FoundLink> links;
  for (const FoundJoint& to : joints)
    for (const FoundJoint& from : joints) {
      if (from.child != to.parent || from.type != FoundJointType::revolute || to.type != FoundJointType::revolute)
        continue;
      const double length =
          distance_of_lines(from.point_in_child, from.axis_in_child, to.point_in_parent, to.axis_in_parent);
      links.push_back({from.child, joint_name(from), joint_name(to), length,
                       std::hypot(across(from.sd.point_in_child), across(to.sd.point_in_parent))});
    }
  return links;
}

Chain found_chain(const std::string& root, const std::vector<FoundJoint>& joints, const std::vector<FoundDhRow>& dh,
                  const Mat3& root_in_ground) {
  KINFER_EXPECT(dh.size() == 3 * joints.size(), "{} rows for {} joints", dh.size(), joints.size());
  Chain chain;
  chain.name = "identified";
  chain.base.rotation = root_in_ground;
  const auto frame_of = [&](const std::string& sensor) {
    const auto found = std::ranges::find(chain.joints, sensor, &Joint::name);
    return sensor == root || found == chain.joints.end() ? -1 : static_cast<int>(found - chain.joints.begin());
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::array<std::string, 3> names{joint_name(joints[i]) + " axis", joint_name(joints[i]), joints[i].child};
    for (std::size_t k = 0; k < 3; ++k) {
      const FoundDhRow& row = dh[3 * i + k];
      Joint joint{.name = names[k]};
      joint.parent = k == 0 ? frame_of(joints[i].parent) : static_cast<int>(chain.joints.size()) - 1;
      const bool moves = k == 1 && joints[i].type != FoundJointType::rigid;
      const bool slides = joints[i].type == FoundJointType::prismatic;
      joint.type = !moves ? JointType::fixed : slides ? JointType::prismatic : JointType::revolute;
      joint.has_reading = moves;
      joint.link = DhLink{row.row};
      chain.joints.push_back(joint);
    }
  }
  return chain;
}

void carry_tool(Chain& chain, const std::vector<FoundPlace>& places) {
  const auto is_tool = [&](const FoundPlace& place) {
    return place.name == "tip" || place.name == "tool" || places.size() == 1;
  };
  const auto tool = std::ranges::find_if(places, is_tool);
  if (tool == places.end()) return;
  const auto flange = std::ranges::find(chain.joints, tool->sensor, &Joint::name);
  if (flange == chain.joints.end()) return;
  chain.tip = static_cast<int>(flange - chain.joints.begin());
  chain.tool.xyz = tool->xyz;
}

}  // namespace kinfer
