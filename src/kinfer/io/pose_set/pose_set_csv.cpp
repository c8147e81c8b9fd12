// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_set_csv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/io/pose_set/pose_columns.hpp"
#include "kinfer/io/pose_set/pose_covariances.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/text_file.hpp"

namespace kinfer {
namespace {

constexpr double quaternion_slack = 0.01;  // a norm further from 1 is not rounding

Dimension joint_dimension(const Chain& chain, int dof_index) {
  const Joint& joint = chain.joints[active_joints(chain)[dof_index]];
  return translates(joint.type) ? Dimension::length : Dimension::angle;
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// One column per joint: "q3" or "q_elbow", with a suffix ("_cmd") or another prefix ("tau").
struct JointColumnNames {
  std::string prefix, suffix;

  std::string by_number(int dof_index) const { return fmt::format("{}{}{}", prefix, dof_index + 1, suffix); }
  std::string by_name(const std::string& name) const { return fmt::format("{}_{}{}", prefix, name, suffix); }

  bool matches(std::string_view column) const {
    return column.size() > prefix.size() + suffix.size() && column.substr(0, prefix.size()) == prefix &&
           column.substr(column.size() - suffix.size()) == suffix &&
           all_digits(column.substr(prefix.size(), column.size() - prefix.size() - suffix.size()));
  }
};

/// The column name of each joint; empty where the file has no such column.
std::vector<std::string> find_joint_columns(PoseColumns& columns, const JointColumnNames& naming,
                                            const std::vector<std::string>& joint_names) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    const std::string number = naming.by_number(static_cast<int>(i)), name = naming.by_name(joint_names[i]);
    if (columns.has(number) && columns.has(name))
      columns.report_header_error(fmt::format("columns {} and {} are the same joint", number, name));
    found.push_back(columns.has(number) ? number : columns.has(name) ? name : "");
  }
  return found;
}

/// Reports an error unless there is exactly one column per joint.
void expect_all_joint_columns(PoseColumns& columns, const JointColumnNames& naming,
                              const std::vector<std::string>& found) {
  const std::string expected =
      fmt::format("expected {} joint columns ({} to {}, or {})", found.size(), naming.by_number(0),
                  naming.by_number(static_cast<int>(found.size()) - 1), naming.by_name("<name>"));
  std::string extra;
  auto count =
      static_cast<std::size_t>(std::count_if(found.begin(), found.end(), [](const auto& n) { return !n.empty(); }));
  for (const std::string_view name : columns.names())
    if (naming.matches(name) && std::find(found.begin(), found.end(), name) == found.end()) extra = name, ++count;
  const auto missing = std::find(found.begin(), found.end(), "");
  if (missing != found.end())
    columns.report_header_error(fmt::format("{}, found {}: {} is missing", expected, count,
                                            naming.by_number(static_cast<int>(missing - found.begin()))));
  if (!extra.empty())
    columns.report_header_error(fmt::format("{}, found {}: the robot has no {}", expected, count, extra));
}

template <class DimensionOf>
MatrixXd read_matrix(PoseColumns& columns, const std::vector<std::string>& names, DimensionOf dimension_of) {
  MatrixXd values = MatrixXd::Constant(names.size(), columns.rows(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto column = columns.numbers(names[i], dimension_of(static_cast<int>(i))))
      for (std::size_t row = 0; row < columns.rows(); ++row) values(i, row) = (*column)[row];
  return values;
}

void read_joints(PoseColumns& columns, const Chain& chain, RequiredContent required, PoseSet& set) {
  set.joint_names = active_joint_names(chain);
  const JointColumnNames naming{"q", ""};
  const auto names = find_joint_columns(columns, naming, set.joint_names);
  const bool none = std::all_of(names.begin(), names.end(), [](const auto& name) { return name.empty(); });
  if (none && required == RequiredContent::targets) {
    set.joints.resize(0, static_cast<Eigen::Index>(columns.rows()));
    return;
  }
  expect_all_joint_columns(columns, naming, names);
  set.joints = read_matrix(columns, names, [&](int dof_index) { return joint_dimension(chain, dof_index); });
  for (std::size_t row = 0; row < columns.rows(); ++row)
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::isnan(set.joints(i, row)))
        columns.report_error(row, fmt::format("column {}: a joint reading is missing", names[i]));
}

/// Joint values that may be absent, all or some; an empty matrix where there are none.
template <class DimensionOf>
MatrixXd read_optional_joint_values(PoseColumns& columns, const JointColumnNames& naming, const PoseSet& set,
                                    DimensionOf dimension_of) {
  const auto names = find_joint_columns(columns, naming, set.joint_names);
  if (std::all_of(names.begin(), names.end(), [](const auto& name) { return name.empty(); })) return {};
  return read_matrix(columns, names, dimension_of);
}

void read_point_deviations(PoseColumns& columns, PoseSet& set) {
  const auto sd = columns.vectors({"sx", "sy", "sz"}, Dimension::length);
  if (!sd) return;
  for (PointMeasurement& point : set.points) {
    if (point.target >= 0 || !sd->measured(point.row)) continue;
    point.sd = sd->at(point.row);
    if (point.sd->minCoeff() < 0) columns.report_error(point.row, "sx, sy, sz: expected standard deviations from 0");
  }
}

void read_points(PoseColumns& columns, const std::array<std::string, 3>& names, int target, PoseSet& set) {
  const auto positions = columns.vectors(names, Dimension::length);
  if (!positions) return;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (positions->measured(row))
      set.points.push_back({static_cast<int>(row), target, positions->at(row), std::nullopt});
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

/// A column "<name>_x" without another meaning must be a target of the robot.
void expect_known_targets(PoseColumns& columns, const Chain& chain) {
  for (const std::string_view name : columns.names()) {
    if (!ends_with(name, "_x") || name == "tilt_x" || name.substr(0, 2) == "q_") continue;
    const std::string_view target = name.substr(0, name.size() - 2);
    const auto is_it = [&](const Target& known) { return known.name == target; };
    if (std::none_of(chain.targets.begin(), chain.targets.end(), is_it))
      columns.report_header_error(fmt::format("column {}: the robot has no [[target]] named \"{}\"", name, target));
  }
}

void read_targets(PoseColumns& columns, const Chain& chain, PoseSet& set) {
  expect_known_targets(columns, chain);
  for (std::size_t i = 0; i < chain.targets.size(); ++i) {
    const std::string& name = chain.targets[i].name;
    read_points(columns, {name + "_x", name + "_y", name + "_z"}, static_cast<int>(i), set);
    set.targets.push_back(name);
  }
  const bool any =
      std::any_of(set.points.begin(), set.points.end(), [](const auto& point) { return point.target >= 0; });
  if (!any) set.targets.clear();
}

void read_quaternions(PoseColumns& columns, PoseSet& set) {
  const auto vector_part = columns.vectors({"qx", "qy", "qz"}, Dimension::one);
  const auto scalar_part = columns.numbers("qw", Dimension::one);
  if (vector_part.has_value() != scalar_part.has_value())
    return columns.report_header_error("an orientation needs the columns qw, qx, qy and qz");
  if (!scalar_part) return;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    if (vector_part->measured(row) == std::isnan((*scalar_part)[row]))
      columns.report_error(row, "expected qw, qx, qy and qz or none of them");
    if (!vector_part->measured(row)) continue;
    const Vec3 v = vector_part->at(row);
    const Quat orientation((*scalar_part)[row], v.x(), v.y(), v.z());
    if (!(std::abs(orientation.norm() - 1.0) <= quaternion_slack))
      columns.report_error(row, fmt::format("qw, qx, qy, qz: expected a norm of 1, found {:.4g}", orientation.norm()));
    else
      set.orientations.push_back({static_cast<int>(row), orientation.normalized(), {}});
  }
}

void read_euler_angles(PoseColumns& columns, const ColumnMap& map, PoseSet& set) {
  if (!map.euler) {
    if (columns.has("rx"))
      columns.report_header_error("columns rx, ry, rz need a column map that says euler = \"XYZ intrinsic\"");
    return;
  }
  const auto angles = columns.vectors({"rx", "ry", "rz"}, Dimension::angle);
  if (!angles) return columns.report_header_error("the column map says \"euler\", expected columns rx, ry and rz");
  if (columns.has("qw"))
    columns.report_header_error("the orientation is given twice, by qw, qx, qy, qz and by rx, ry, rz");
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (angles->measured(row))
      set.orientations.push_back(
          {static_cast<int>(row), Quat(from_euler(*map.euler, angles->at(row))).normalized(), {}});
}

void read_orientation_deviations(PoseColumns& columns, PoseSet& set) {
  const auto sd = columns.vectors({"srx", "sry", "srz"}, Dimension::angle);
  if (!sd) return;
  for (OrientationMeasurement& measured : set.orientations) {
    if (!sd->measured(measured.row)) continue;
    measured.sd = sd->at(measured.row);
    if (measured.sd->minCoeff() < 0)
      columns.report_error(measured.row, "srx, sry, srz: expected standard deviations from 0");
  }
}

void read_tilts(PoseColumns& columns, PoseSet& set) {
  const auto tilts = columns.vectors({"tilt_x", "tilt_y", "tilt_z"}, Dimension::acceleration);
  if (!tilts) return;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (tilts->measured(row)) set.tilts.push_back({static_cast<int>(row), tilts->at(row)});
}

void read_contacts(PoseColumns& columns, PoseSet& set) {
  if (auto sockets = columns.name_indices("socket")) {
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (sockets->index[row] >= 0) set.contacts.push_back({static_cast<int>(row), sockets->index[row]});
    set.sockets = std::move(sockets->names);
  }
  if (auto planes = columns.name_indices("plane")) {
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (planes->index[row] >= 0) set.plane_contacts.push_back({static_cast<int>(row), planes->index[row]});
    set.planes = std::move(planes->names);
  }
}

/// `distance`: the distances not yet assigned to an anchor or a pair; set to NaN here once assigned.
void read_anchor_distances(PoseColumns& columns, RequiredContent required, NumberColumn& distance, PoseSet& set) {
  const auto anchor = columns.numbers("anchor", Dimension::one);
  if (!anchor) return;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const double number = (*anchor)[row];
    if (std::isnan(number)) continue;
    if (!(number >= 1 && number <= 1e6 && number == std::floor(number)))
      columns.report_error(row, fmt::format("column anchor: expected a whole number from 1, found {}", number));
    else if (std::isnan(distance[row]) && required == RequiredContent::measurements)
      columns.report_error(row, "column distance: the distance from the anchor is missing");
    else
      set.distances.push_back({static_cast<int>(row), static_cast<int>(number) - 1, distance[row]});
    distance[row] = std::numeric_limits<double>::quiet_NaN();
  }
}

void read_pairs(PoseColumns& columns, NumberColumn& distance, PoseSet& set) {
  const auto pairs = columns.name_indices("pair");
  if (!pairs) return;
  for (std::size_t k = 0; k < pairs->names.size(); ++k) {
    std::vector<int> rows;
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (pairs->index[row] == static_cast<int>(k)) rows.push_back(static_cast<int>(row));
    if (rows.size() != 2) {
      columns.report_error(rows.front(), fmt::format("column pair: expected 2 rows of pair \"{}\", found {}",
                                                     pairs->names[k], rows.size()));
      continue;
    }
    double &first = distance[rows[0]], &second = distance[rows[1]];
    if (std::isnan(first)) first = second;
    if (std::isnan(first)) columns.report_error(rows[0], "column distance: the distance of the pair is missing");
    if (!std::isnan(second) && first != second)
      columns.report_error(
          rows[1], fmt::format("column distance: the rows of pair \"{}\" give different distances", pairs->names[k]));
    set.pairs.push_back({rows[0], rows[1], first});
    first = second = std::numeric_limits<double>::quiet_NaN();
  }
}

void read_distances(PoseColumns& columns, RequiredContent required, PoseSet& set) {
  auto distance = columns.numbers("distance", Dimension::length);
  NumberColumn none(columns.rows(), std::numeric_limits<double>::quiet_NaN());
  NumberColumn& given = distance ? *distance : none;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (given[row] < 0) columns.report_error(row, "column distance: expected a number from 0");
  read_anchor_distances(columns, required, given, set);
  read_pairs(columns, given, set);
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (!std::isnan(given[row])) columns.report_error(row, "column distance: expected an anchor or a pair beside it");
}

std::vector<SplitLabel> read_labels(PoseColumns& columns) {
  std::vector<SplitLabel> labels;
  const auto texts = columns.texts("set");
  if (!texts) return labels;
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const std::string& text = (*texts)[row];
    if (!text.empty() && text != "train" && text != "holdout")
      columns.report_error(row, fmt::format("column set: expected \"train\" or \"holdout\", found \"{}\"", text));
    labels.push_back(text == "train" ? SplitLabel::train : text == "holdout" ? SplitLabel::holdout : SplitLabel::none);
  }
  return labels;
}

void read_row_attributes(PoseColumns& columns, PoseSet& set) {
  set.payload = columns.numbers("payload", Dimension::mass).value_or(NumberColumn{});
  for (double& payload : set.payload)
    if (std::isnan(payload)) payload = 0.0;
  set.temperature = columns.numbers("temperature", Dimension::temperature).value_or(NumberColumn{});
  set.id = columns.texts("id").value_or(std::vector<std::string>{});
  set.set = read_labels(columns);
  NameColumn setups = columns.name_indices("setup").value_or(NameColumn{});
  set.setups = std::move(setups.names);
  set.setup = std::move(setups.index);
  NameColumn tips = columns.name_indices("tip").value_or(NameColumn{});
  set.tips = std::move(tips.names);
  set.tip = std::move(tips.index);
  NameColumn sweeps = columns.name_indices("sweep").value_or(NameColumn{});
  set.sweeps = std::move(sweeps.names);
  set.sweep = std::move(sweeps.index);
}

PoseSet read_columns(PoseColumns& columns, const Chain& chain, const ColumnMap& map, RequiredContent required) {
  PoseSet set;
  read_joints(columns, chain, required, set);
  set.commanded = read_optional_joint_values(columns, {"q", "_cmd"}, set,
                                             [&](int dof_index) { return joint_dimension(chain, dof_index); });
  set.torques = read_optional_joint_values(columns, {"tau", ""}, set, [](int) { return Dimension::torque; });
  read_points(columns, {"x", "y", "z"}, -1, set);
  read_targets(columns, chain, set);
  read_point_deviations(columns, set);
  read_quaternions(columns, set);
  read_euler_angles(columns, map, set);
  read_orientation_deviations(columns, set);
  read_covariances(columns, set);
  read_tilts(columns, set);
  read_contacts(columns, set);
  read_distances(columns, required, set);
  read_row_attributes(columns, set);
  for (std::size_t row = 0; row < columns.rows(); ++row) set.line.push_back(columns.line(row));
  return set;
}

/// A file with another delimiter looks like one with a single column.
bool has_other_delimiter(const CsvHeader& header, const ColumnMap& map) {
  if (header.columns.size() != 1) return false;
  return header.columns[0].find_first_of(map.delimiter == ';' ? ",\t" : ";\t") != std::string::npos;
}

}  // namespace

Result<PoseSet> parse_pose_set(std::string_view text, const std::string& name, const Chain& chain, const ColumnMap& map,
                               RequiredContent required) {
  KINFER_TRY(table, split_csv(text, name, {map.delimiter, map.decimal, map.skip_lines}));
  const CsvHeader& header = table.header;
  if (has_other_delimiter(header, map))
    return error("{}:{}: expected columns separated by \"{}\"; a column map can say delimiter = \";\"", name,
                 header.line, map.delimiter);
  if (map.columns.empty())
    if (auto distinct = expect_distinct_columns(header, name); !distinct) return forward_error(distinct.error());
  FirstError first_error(name);
  PoseColumns columns(table, map, first_error);
  PoseSet set = read_columns(columns, chain, map, required);
  if (required == RequiredContent::measurements) columns.expect_all_taken();
  if (table.rows() == 0) first_error.report(header.line, "the file has a header but no rows, expected one row a pose");
  if (required == RequiredContent::measurements && !has_measurements(set))
    first_error.report(header.line, "nothing is measured in this file, expected columns as x,y,z beside the joints");
  if (required == RequiredContent::targets && set.points.size() != table.rows())
    first_error.report(header.line, "expected the columns x, y, z of the wanted tool point in every row");
  if (first_error.any()) return forward_error(first_error.as_error());
  return set;
}

Result<PoseSet> read_pose_set(const std::filesystem::path& path, const Chain& chain, const ColumnMap& map,
                              RequiredContent required) {
  KINFER_TRY(text, read_text_file(path));
  return parse_pose_set(text, path.string(), chain, map, required);
}

}  // namespace kinfer
