// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/joints_toml.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/robot/model/possible_chain.hpp"

namespace kinfer {
namespace {

constexpr const char* known_conventions = "\"dh\", \"mdh\" or \"urdf\"";
constexpr const char* base_name = "base";  // as a parent, unless a joint has this name; "" is always the base

DhNumbers read_dh_numbers(TableReader& row, const Scales& scales) {
  DhNumbers numbers;
  numbers.a = row.number("a") * scales.length;
  numbers.alpha = row.number("alpha") * scales.angle;
  numbers.d = row.number("d") * scales.length;
  numbers.theta = row.number("theta") * scales.angle;
  numbers.beta = row.number_or("beta", 0.0) * scales.angle;
  for (const char* key : {"a_sd", "alpha_sd", "d_sd", "theta_sd", "beta_sd"}) row.ignore(key);
  return numbers;
}

UrdfLink read_urdf_link(TableReader& row, JointType type, const Scales& scales) {
  UrdfLink link;
  link.origin.xyz = row.vector_or("xyz", Vec3::Zero()) * scales.length;
  link.origin.rotation = from_rpy(row.vector_or("rpy", Vec3::Zero()) * scales.angle);
  for (const char* key : {"xyz_sd", "turn_sd"}) row.ignore(key);
  if (!has_position(type)) return row.ignore("axis"), link;
  const Vec3 axis = row.vector("axis");
  if (row.has("axis") && axis.norm() < 1e-9)
    row.report_error(row.line_of("axis"), "\"axis\": expected a direction, found zeros");
  if (axis.norm() >= 1e-9) link.axis = axis.normalized();
  return link;
}

Link read_link(TableReader& row, JointType type, Convention convention, const Scales& scales) {
  switch (convention) {
    case Convention::dh:
      return DhLink{read_dh_numbers(row, scales)};
    case Convention::mdh:
      return MdhLink{read_dh_numbers(row, scales)};
    case Convention::urdf:
      return read_urdf_link(row, type, scales);
  }
  return MdhLink{};
}

JointType read_type(TableReader& row) {
  const std::string name = row.text("type");
  const auto type = joint_type_named(name);
  if (!type && row.has("type"))
    row.report_error(row.line_of("type"), fmt::format("\"type\": expected {}, found \"{}\"", joint_type_names(), name));
  return type.value_or(JointType::revolute);
}

void read_limits(TableReader& row, Joint& joint, const Scales& scales) {
  if (!row.has("limits")) return;
  const double scale = translates(joint.type) ? scales.length : scales.angle;
  const std::vector<double> limits = row.numbers("limits", 2);
  if (limits[0] > limits[1])
    row.report_error(row.line_of("limits"), "\"limits\": expected [lower, upper] in this order");
  joint.lower = limits[0] * scale;
  joint.upper = limits[1] * scale;
}

/// A joint without its relations to other joints (parent, couplings).
Joint read_joint(TableReader& row, const std::string& default_name, Convention of_file, const Scales& scales) {
  Joint joint;
  joint.name = row.text_or("name", default_name);
  if (joint.name.empty()) row.report_error(row.line_of("name"), "\"name\": expected a name, found an empty text");
  joint.type = read_type(row);
  joint.link = read_link(row, joint.type, read_convention(row, of_file), scales);
  joint.is_active = !has_position(joint.type) ? (row.ignore("reading"), false) : row.flag_or("reading", true);
  joint.gain = row.number_or("gain", 1.0);
  joint.compliance = row.number_or("compliance", 0.0);
  joint.torque_compliance = row.number_or("torque_compliance", 0.0);
  joint.backlash = row.number_or("backlash", 0.0) * (translates(joint.type) ? scales.length : scales.angle);
  for (const Vec3& h : row.vectors_or_none("harmonics"))
    joint.harmonics.push_back({h[0], h[1] * scales.angle, h[2] * scales.angle});
  if (!joint.harmonics.empty() && !rotates(joint.type))
    row.report_error(row.line_of("harmonics"), "\"harmonics\": only revolute joints have them");
  for (const char* key : {"gain_sd", "compliance_sd", "torque_compliance_sd", "backlash_sd", "harmonics_sd"})
    row.ignore(key);
  read_limits(row, joint, scales);
  return joint;
}

int find_joint(const std::vector<Joint>& joints, std::string_view name) {
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const Joint& joint) { return joint.name == name; });
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

std::string names_of(const std::vector<Joint>& joints) {
  std::string names;
  for (const Joint& joint : joints) names += (names.empty() ? "" : ", ") + joint.name;
  return names;
}

int read_parent(TableReader& row, int self, const std::vector<Joint>& joints) {
  if (!row.has("parent")) return row.ignore("parent"), self - 1;
  const std::string name = row.text("parent");
  if (name.empty() || (name == base_name && find_joint(joints, name) < 0)) return -1;
  const int parent = read_joint_reference(row, "parent", joints);
  if (parent >= self)
    row.report_error(row.line_of("parent"),
                     fmt::format("\"parent\": \"{}\" must be a joint above this one, so that there is no loop",
                                 joints[parent].name));
  return std::min(parent, self - 1);
}

std::vector<Coupling> read_couplings(TableReader& row, const std::vector<Joint>& joints, FirstError& first_error) {
  std::vector<Coupling> couplings;
  const TomlTable* table = row.table_or_none("coupling");
  if (!table) return couplings;
  TableReader reader(*table, row.line_of("coupling"), "coupling: ", first_error);
  for (const auto& [name, value] : table->entries) {
    const int index = find_joint(joints, name);
    if (index < 0)
      reader.report_error(value.line, fmt::format("no joint is named \"{}\" (there are {})", name, names_of(joints)));
    else if (!joints[index].is_active)
      reader.report_error(value.line, fmt::format("joint \"{}\" has no joint position", name));
    couplings.push_back({index, reader.number(name)});
  }
  return couplings;
}

using Rows = std::vector<std::pair<const TomlTable*, int>>;

void expect_distinct_names(const std::vector<Joint>& joints, const Rows& rows, FirstError& first_error) {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (const int first = find_joint(joints, joints[i].name); first < static_cast<int>(i))
      first_error.report(rows[i].second, fmt::format("joint {}: the name \"{}\" is taken by joint {}", i + 1,
                                                     joints[i].name, first + 1));
}

/// The frame of a joint, or of the base as in read_parent.
int read_frame_reference(TableReader& row, std::string_view key, const std::vector<Joint>& joints) {
  const std::string name = row.text(key);
  const bool is_base = name.empty() || (name == base_name && find_joint(joints, name) < 0);
  return is_base ? -1 : read_joint_reference(row, key, joints);
}

Vec3 read_axis(TableReader& row, std::string_view key) {
  const Vec3 axis = row.vector(key);
  if (axis.norm() > 0.0) return axis.normalized();
  row.report_error(row.line_of(key), fmt::format("\"{}\": expected a direction, found zeros", key));
  return Vec3::UnitZ();
}

}  // namespace

Convention read_convention(TableReader& table, std::optional<Convention> fallback) {
  if (fallback && !table.has("convention")) return table.ignore("convention"), *fallback;
  const int line = table.line_of("convention");
  if (!table.has("convention"))
    table.report_error(line, fmt::format("\"convention\" is missing, expected {}", known_conventions));
  const std::string name = table.text_or("convention", "mdh");
  if (name == "dh") return Convention::dh;
  if (name == "mdh") return Convention::mdh;
  if (name == "urdf") return Convention::urdf;
  table.report_error(line, fmt::format("\"convention\": expected {}, found \"{}\"", known_conventions, name));
  return Convention::mdh;
}

int read_joint_reference(TableReader& row, std::string_view key, const std::vector<Joint>& joints) {
  const std::string name = row.text(key);
  const int index = find_joint(joints, name);
  if (index < 0)
    row.report_error(row.line_of(key),
                     fmt::format("\"{}\": no joint is named \"{}\" (there are {})", key, name, names_of(joints)));
  return index;
}

std::vector<Joint> read_joints(TableReader& file, Convention convention, const Scales& scales,
                               FirstError& first_error) {
  const Rows rows = file.tables_or_none("joint");
  if (rows.empty()) file.report_error(1, "the robot has no joints, expected at least one [[joint]]");
  std::vector<TableReader> readers;
  std::vector<Joint> joints;
  for (const auto& [table, line] : rows) {
    const std::size_t number = joints.size() + 1;
    readers.emplace_back(*table, line, fmt::format("joint {}: ", number), first_error);
    joints.push_back(read_joint(readers.back(), fmt::format("J{}", number), convention, scales));
  }
  expect_distinct_names(joints, rows, first_error);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i].parent = read_parent(readers[i], static_cast<int>(i), joints);
    joints[i].couplings = read_couplings(readers[i], joints, first_error);
    readers[i].expect_no_other_keys();
    if (const auto what = impossible_number(joints[i])) readers[i].report_error(rows[i].second, *what);
  }
  return joints;
}

std::vector<LoopClosure> read_closures(TableReader& file, const std::vector<Joint>& joints, const Scales& scales,
                                       FirstError& first_error) {
  std::vector<LoopClosure> closures;
  for (const auto& [table, line] : file.tables_or_none("closure")) {
    TableReader row(*table, line, fmt::format("closure {}: ", closures.size() + 1), first_error);
    LoopClosure closure{.name = row.text_or("name", fmt::format("C{}", closures.size() + 1))};
    closure.first = read_frame_reference(row, "first", joints);
    closure.second = read_frame_reference(row, "second", joints);
    closure.point_in_first = row.vector("point_in_first") * scales.length;
    closure.axis_in_first = read_axis(row, "axis_in_first");
    closure.point_in_second = row.vector("point_in_second") * scales.length;
    closure.axis_in_second = read_axis(row, "axis_in_second");
    row.expect_no_other_keys();
    if (closure.first == closure.second) row.report_error(line, "\"first\" and \"second\": expected two frames");
    closures.push_back(std::move(closure));
  }
  return closures;
}

}  // namespace kinfer
