// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/robot_toml.hpp"

#include <algorithm>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/robot/model/possible_chain.hpp"
#include "kinfer/io/robot/toml/displacement_field_toml.hpp"
#include "kinfer/io/robot/toml/prediction_toml.hpp"
#include "kinfer/io/text/text_file.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {
namespace {

enum class Convention { dh, mdh, urdf };

constexpr const char* known_conventions = "\"dh\", \"mdh\" or \"urdf\"";
constexpr const char* base_name = "base";  // as a parent, unless a joint has this name; "" is always the base

struct Scales {
  double length = 1.0;  ///< [m]
  double angle = 1.0;   ///< [rad]

  double of(ResidualUnit unit) const {
    return unit == ResidualUnit::length ? length : unit == ResidualUnit::angle ? angle : 1.0;
  }
};

double scale_of(TableReader& units, std::string_view key, Dimension dimension) {
  const std::string name = units.text_or(key, dimension == Dimension::length ? "m" : "rad");
  const auto unit = find_unit(name);
  if (unit && unit->dimension == dimension) return unit->factor;
  units.report_error(units.line_of(key),
                     fmt::format("\"{}\": expected {}, found \"{}\"", key, describe(dimension), name));
  return 1.0;
}

Scales read_scales(TableReader& file, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("units");
  if (!table) return {};
  TableReader units(*table, file.line_of("units"), "units: ", first_error);
  const Scales scales{scale_of(units, "length", Dimension::length), scale_of(units, "angle", Dimension::angle)};
  units.expect_no_other_keys();
  return scales;
}

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

Frame read_frame(TableReader& file, std::string_view key, const Scales& scales, FirstError& first_error) {
  file.ignore(std::string(key) + "_sd");
  const TomlTable* table = file.table_or_none(key);
  if (!table) return {};
  TableReader frame(*table, file.line_of(key), std::string(key) + ": ", first_error);
  const Vec3 xyz = frame.vector_or("xyz", Vec3::Zero()), rpy = frame.vector_or("rpy", Vec3::Zero());
  frame.expect_no_other_keys();
  return {xyz * scales.length, from_rpy(rpy * scales.angle), Vec3::Zero()};
}

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

/// Index of the joint named under `key`; −1 and an error where there is none.
int read_joint_reference(TableReader& row, std::string_view key, const std::vector<Joint>& joints) {
  const std::string name = row.text(key);
  const int index = find_joint(joints, name);
  if (index < 0)
    row.report_error(row.line_of(key),
                     fmt::format("\"{}\": no joint is named \"{}\" (there are {})", key, name, names_of(joints)));
  return index;
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

std::vector<Target> read_targets(TableReader& file, const Scales& scales, FirstError& first_error) {
  std::vector<Target> targets;
  for (const auto& [table, line] : file.tables_or_none("target")) {
    TableReader row(*table, line, fmt::format("target {}: ", targets.size() + 1), first_error);
    Target target{row.text("name"), row.vector("xyz") * scales.length};
    row.ignore("xyz_sd");
    row.expect_no_other_keys();
    for (const Target& other : targets)
      if (other.name == target.name) row.report_error(line, fmt::format("the name \"{}\" is taken", target.name));
    targets.push_back(std::move(target));
  }
  return targets;
}

/// The functions `read_fixture` read a table [[kind]] by the type of the fixture.
Target read_fixture(TableReader& row, const Scales& scales, Target target) {
  target.name = row.text("name"), target.xyz = row.vector_or("xyz", Vec3::Zero()) * scales.length;
  row.ignore("xyz_sd");
  return target;
}

Plane read_fixture(TableReader& row, const Scales& scales, Plane plane) {
  plane.name = row.text("name"), plane.offset = row.number("offset") * scales.length;
  const Vec3 normal = row.vector("normal");
  if (normal.norm() > 0.0) plane.rotation = rotation_between(Vec3::UnitZ(), normal).toRotationMatrix();
  row.ignore("offset_sd");
  return plane;
}

NamedFrame read_fixture(TableReader& row, const Scales& scales, NamedFrame fixture) {
  fixture.name = row.text("name");
  const Vec3 xyz = row.vector_or("xyz", Vec3::Zero()), rpy = row.vector_or("rpy", Vec3::Zero());
  fixture.frame = {xyz * scales.length, from_rpy(rpy * scales.angle), Vec3::Zero()};
  row.ignore("xyz_sd"), row.ignore("turn_sd");
  return fixture;
}

template <class T>
std::vector<T> read_fixture_list(TableReader& file, std::string_view kind, const Scales& scales,
                                 FirstError& first_error) {
  std::vector<T> fixtures;
  for (const auto& [table, line] : file.tables_or_none(kind)) {
    TableReader row(*table, line, fmt::format("{} {}: ", kind, fixtures.size() + 1), first_error);
    fixtures.push_back(read_fixture(row, scales, T{}));
    row.expect_no_other_keys();
  }
  return fixtures;
}

/// Points without a name are one array: "anchors" of the kind "anchor".
std::vector<Vec3> read_points(TableReader& file, const std::string& key, const Scales& scales) {
  std::vector<Vec3> points = file.vectors_or_none(key);
  for (Vec3& point : points) point *= scales.length;
  file.ignore(key + "_sd");
  return points;
}

Fixtures read_fixtures(TableReader& file, const Scales& scales, FirstError& first_error) {
  Fixtures fixtures;
  for_each_fixture_list(fixtures, [&]<class T>(const auto& row, std::vector<T>& list) {
    if constexpr (std::is_same_v<T, Vec3>)
      list = read_points(file, std::string(row.kind) + "s", scales);
    else
      list = read_fixture_list<T>(file, row.kind, scales, first_error);
  });
  return fixtures;
}

/// Index of the socket of that name, which is added at the origin where the file has no [[socket]] of that name.
int socket_index(std::vector<Target>& sockets, const std::string& name) {
  for (std::size_t i = 0; i < sockets.size(); ++i)
    if (sockets[i].name == name) return static_cast<int>(i);
  sockets.push_back({name, Vec3::Zero()});
  return static_cast<int>(sockets.size()) - 1;
}

void read_socket_distances(TableReader& file, Fixtures& fixtures, const Scales& scales, FirstError& first_error) {
  for (const auto& [table, line] : file.tables_or_none("socket_distance")) {
    TableReader row(*table, line, fmt::format("socket_distance {}: ", fixtures.socket_distances.size() + 1),
                    first_error);
    const std::string a = row.text("from"), b = row.text("to");
    SocketDistance known{socket_index(fixtures.sockets, a), socket_index(fixtures.sockets, b)};
    known.distance = row.number("distance") * scales.length;
    known.sd = row.positive_or("sigma", 1e-5 / scales.length) * scales.length;
    row.expect_no_other_keys();
    if (a == b) row.report_error(line, "expected two different sockets");
    fixtures.socket_distances.push_back(known);
  }
}

std::vector<RobotMounting> read_mountings(TableReader& file, const std::vector<Joint>& joints, const Scales& scales,
                                          FirstError& first_error) {
  std::vector<RobotMounting> mountings;
  for (const auto& [table, line] : file.tables_or_none("mounting")) {
    TableReader row(*table, line, fmt::format("mounting {}: ", mountings.size() + 1), first_error);
    RobotMounting mounting{.name = row.text("name")};
    if (row.has("base")) mounting.base = read_frame(row, "base", scales, first_error);
    row.ignore("base"), row.ignore("base_sd");
    mounting.tool = read_frame(row, "tool", scales, first_error);
    mounting.tip = row.has("tip") ? read_joint_reference(row, "tip", joints) : (row.ignore("tip"), -1);
    row.expect_no_other_keys();
    mountings.push_back(std::move(mounting));
  }
  return mountings;
}

std::vector<PointMass> read_masses(TableReader& file, int joints, const Scales& scales, FirstError& first_error) {
  std::vector<PointMass> masses;
  for (const auto& [table, line] : file.tables_or_none("mass")) {
    TableReader row(*table, line, fmt::format("mass {}: ", masses.size() + 1), first_error);
    const double link = row.number("link");
    const bool known = link >= 1 && link <= joints && link == static_cast<int>(link);
    if (row.has("link") && !known)
      row.report_error(row.line_of("link"), fmt::format("\"link\": expected a whole number from 1 to {}", joints));
    const double mass = row.number("mass");
    if (mass < 0) row.report_error(row.line_of("mass"), "\"mass\": expected a number from 0");
    masses.push_back({known ? static_cast<int>(link) - 1 : 0, row.vector("com") * scales.length, mass});
    row.expect_no_other_keys();
  }
  return masses;
}

Tolerances read_tolerances(TableReader& file, const Scales& scales, FirstError& first_error) {
  Tolerances tolerances;
  const TomlTable* table = file.table_or_none("tolerance");
  if (!table) return tolerances;
  TableReader reader(*table, file.line_of("tolerance"), "tolerance: ", first_error);
  const auto read = [&](std::string_view key, double& value, double scale) {
    value = reader.positive_or(key, value / scale) * scale;
  };
  read("length", tolerances.length, scales.length);
  read("angle", tolerances.angle, scales.angle);
  read("base_length", tolerances.base_length, scales.length);
  read("base_angle", tolerances.base_angle, scales.angle);
  read("tool_length", tolerances.tool_length, scales.length);
  read("tool_angle", tolerances.tool_angle, scales.angle);
  read("gain", tolerances.gain, 1.0);
  read("compliance", tolerances.compliance, 1.0);
  read("anchor", tolerances.anchor, scales.length);
  reader.expect_no_other_keys();
  return tolerances;
}

double non_negative_or_zero(TableReader& reader, std::string_view key) {
  const double value = reader.number_or(key, 0.0);
  if (value < 0) reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected a number from 0", key));
  return value;
}

/// Of an instrument whose `sigma` is not stated: the larger of those of its wires, bars and contacts.
std::optional<double> stated_length_sigma(const Instrument& instrument) {
  if (!instrument.sigma_distance && !instrument.sigma_contact) return std::nullopt;
  return std::max(instrument.sigma_distance.value_or(0.0), instrument.sigma_contact.value_or(0.0));
}

bool states_any_accuracy(const Instrument& instrument) {
  return instrument.states_lengths() || instrument.sigma_angle > 0.0 ||
         std::ranges::any_of(instrument_sigmas,
                             [&](const InstrumentSigma& s) { return (instrument.*s.value).has_value(); });
}

/// Of a stated accuracy: zero means noise-free and not that it is unknown.
double noise_free_at_zero(double sigma) {
  constexpr double noise_free = 1e-9;  // [m], [rad], [m/s²]
  return std::max(sigma, noise_free);
}

/// Empty where no accuracy is stated; those that are not are zero, and estimated from the residuals.
std::optional<Instrument> read_instrument(TableReader& file, const Scales& scales, std::optional<Vec3>& at,
                                          FirstError& first_error) {
  const TomlTable* table = file.table_or_none("instrument");
  if (!table) return std::nullopt;
  TableReader reader(*table, file.line_of("instrument"), "instrument: ", first_error);
  reader.text_or("kind", "position");
  Instrument instrument;
  const double length = non_negative_or_zero(reader, "sigma") * scales.length,
               angle = non_negative_or_zero(reader, "sigma_angle") * scales.angle;
  if (reader.has("sigma_angle")) instrument.sigma_angle = noise_free_at_zero(angle);
  instrument.ppm = non_negative_or_zero(reader, "ppm");
  for (const InstrumentSigma& sigma : instrument_sigmas) {
    const double value = non_negative_or_zero(reader, sigma.key) * scales.of(sigma.unit);
    if (reader.has(sigma.key)) instrument.*sigma.value = noise_free_at_zero(value);
  }
  if (reader.has("at")) at = reader.vector("at") * scales.length;
  reader.expect_no_other_keys();
  instrument.sigma = reader.has("sigma") ? noise_free_at_zero(length) : stated_length_sigma(instrument).value_or(0.0);
  if (!states_any_accuracy(instrument)) return std::nullopt;
  return instrument;
}

}  // namespace

Result<RobotModel> parse_robot_toml(std::string_view text, const std::string& name) {
  KINFER_TRY(table, parse_toml(text, name));
  FirstError first_error(name);
  TableReader file(table, 1, "", first_error);
  RobotModel robot;
  Chain& chain = robot.chain;
  chain.name = file.text_or("name", std::filesystem::path(name).stem().string());
  const Scales scales = read_scales(file, first_error);
  const Convention convention = read_convention(file, std::nullopt);
  chain.base = read_frame(file, "base", scales, first_error);
  chain.tool = read_frame(file, "tool", scales, first_error);
  chain.gravity = file.vector_or("gravity", chain.gravity);
  chain.joints = read_joints(file, convention, scales, first_error);
  chain.closures = read_closures(file, chain.joints, scales, first_error);
  chain.tip = file.has("tip") ? read_joint_reference(file, "tip", chain.joints) : (file.ignore("tip"), -1);
  chain.targets = read_targets(file, scales, first_error);
  chain.masses = read_masses(file, static_cast<int>(chain.joints.size()), scales, first_error);
  robot.tolerances = read_tolerances(file, scales, first_error);
  robot.instrument = read_instrument(file, scales, robot.instrument_position, first_error);
  chain.fixtures = read_fixtures(file, scales, first_error);
  read_socket_distances(file, chain.fixtures, scales, first_error);
  chain.mountings = read_mountings(file, chain.joints, scales, first_error);
  chain.setup = file.text_or("setup", "");
  chain.expansion = file.number_or("expansion", 0.0);
  chain.reference_temperature = file.number_or("reference_temperature", 0.0);
  file.ignore("expansion_sd");
  chain.field = read_displacement_field(file, dof(chain), first_error);
  robot.prediction = read_prediction(file, dof(chain), first_error);
  file.expect_no_other_keys();
  if (first_error.any()) return forward_error(first_error.as_error());
  if (const auto what = impossible_model(chain)) return error("{}: {}", name, *what);
  return robot;
}

Result<RobotModel> read_robot_toml(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_robot_toml(text, path.string());
}

}  // namespace kinfer
