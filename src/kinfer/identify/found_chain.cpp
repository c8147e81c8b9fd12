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

constexpr double parallel = 1e-3;  // sine below which two lines count as parallel

/// What a link reaches to or from: an axis line, or a centre.
struct Pivot {
  Vec3 point = Vec3::Zero(), axis = Vec3::Zero();  // axis zero: a centre
  double point_sd = 0.0, axis_sd = 0.0;
};

/// Shortest distance, and its standard deviation. Lines that are nearly parallel are nearest to each other far away,
/// and where that is hangs on their small angle: the deviation says so.
std::pair<double, double> distance(const Pivot& a, const Pivot& b) {
  const Vec3 between = b.point - a.point, across = a.axis.cross(b.axis);
  double sd = std::hypot(a.point_sd, b.point_sd);
  if (across.norm() < parallel) {
    const Vec3 along = a.axis.norm() > 0.5 ? a.axis : b.axis;
    return {(between - along.dot(between) * along).norm(), sd};
  }
  const Vec3 normal = across.normalized();
  const double sideways = between.dot(normal.cross(a.axis));
  sd = std::hypot(sd, sideways * std::hypot(a.axis_sd, b.axis_sd) / across.norm());
  return {std::abs(between.dot(normal)), sd};
}

double sd_across(const std::array<double, 2>& sd) {
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

std::vector<Vec3> joint_axes(FoundJointType type, const HingeGeometry& geometry) {
  if (type == FoundJointType::universal)
    return {geometry.axis_in_parent, geometry.home.rotation * geometry.axis_in_child};
  if (type == FoundJointType::spherical)
    return {geometry.ball_axes.col(0), geometry.ball_axes.col(1), geometry.ball_axes.col(2)};
  return {geometry.axis_in_parent};
}

std::vector<DhNumbers> joint_rows(FoundJointType type, const HingeGeometry& geometry) {
  return rows_through(geometry.point_in_parent, joint_axes(type, geometry), geometry.home);
}

std::vector<FoundDhRow> canonical_rows(const FoundJoint& joint, const FoundHinge& hinge) {
  const std::vector<DhNumbers> numbers = joint_rows(joint.type, hinge.geometry);
  const std::vector<DhNumbers>& sd = hinge.precision.canonical_sd;
  const std::size_t axes = numbers.size() - 2;
  const auto variable = [&](std::size_t row) {
    if (joint.type == FoundJointType::rigid || row == 0 || row > axes) return std::string();
    return axes == 1 ? joint_name(joint) : fmt::format("{} {}", joint_name(joint), row);
  };
  const bool slides = joint.type == FoundJointType::prismatic;
  std::vector<FoundDhRow> rows;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    rows.push_back({.segment = joint.child,
                    .row = numbers[i],
                    .sd = i < sd.size() ? sd[i] : DhNumbers{},
                    .theta_variable = slides ? "" : variable(i),
                    .alpha_variable = "",
                    .d_variable = slides ? variable(i) : ""});
  return rows;
}

std::vector<FoundLink> found_links(const std::vector<FoundJoint>& joints) {
  const auto turns = [](const FoundJoint& j) {
    return j.type == FoundJointType::revolute || j.type == FoundJointType::spherical;
  };
  const auto axis_of = [](const FoundJoint& j, const Vec3& axis) {
    return j.type == FoundJointType::spherical ? Vec3(Vec3::Zero()) : axis;
  };
  std::vector<FoundLink> links;
  for (const FoundJoint& to : joints)
    for (const FoundJoint& from : joints) {
      if (from.child != to.parent || !turns(from) || !turns(to)) continue;
      const auto [length, sd] = distance({from.point_in_child, axis_of(from, from.axis_in_child),
                                          sd_across(from.sd.point_in_child), sd_across(from.sd.axis_in_child)},
                                         {to.point_in_parent, axis_of(to, to.axis_in_parent),
                                          sd_across(to.sd.point_in_parent), sd_across(to.sd.axis_in_parent)});
      links.push_back({from.child, joint_name(from), joint_name(to), length, sd});
    }
  return links;
}

Chain found_chain(const std::string& root, const std::vector<FoundJoint>& joints, const std::vector<FoundDhRow>& dh,
                  const Mat3& root_in_ground) {
  Chain chain;
  chain.name = "identified";
  chain.base.rotation = root_in_ground;
  const auto frame_of = [&](const std::string& sensor) {
    const auto found = std::ranges::find(chain.joints, sensor, &Joint::name);
    return sensor == root || found == chain.joints.end() ? -1 : static_cast<int>(found - chain.joints.begin());
  };
  auto row = dh.begin();
  for (const FoundJoint& found : joints) {
    const auto first = row, last = std::find_if(row, dh.end(), [&](const auto&r) { return r.segment != found.child; });
    KINFER_EXPECT(last - first >= 3, "{} rows lead to {}", last - first, found.child);
    for (; row != last; ++row) {
      Joint joint{.name = row == first ? joint_name(found) + " axis" : row->variable()};
      if (joint.name.empty()) joint.name = row + 1 == last ? found.child : joint_name(found);
      joint.parent = row == first ? frame_of(found.parent) : static_cast<int>(chain.joints.size()) - 1;
      joint.has_reading = !row->variable().empty();
      joint.type = !joint.has_reading         ? JointType::fixed
                   : !row->d_variable.empty() ? JointType::prismatic
                                              : JointType::revolute;
      joint.link = DhLink{row->row};
      chain.joints.push_back(joint);
    }
  }
  KINFER_EXPECT(row == dh.end(), "rows of no joint");
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
