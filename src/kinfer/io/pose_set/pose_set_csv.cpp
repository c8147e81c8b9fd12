// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_set_csv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/measurement_columns.hpp"
#include "kinfer/io/pose_set/pose_covariances.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer {
namespace {

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
        columns.report_error(row, fmt::format("column {}: a joint position is missing", names[i]));
}

/// Joint values that may be absent, all or some; an empty matrix where there are none.
template <class DimensionOf>
MatrixXd read_optional_joint_values(PoseColumns& columns, const JointColumnNames& naming, const PoseSet& set,
                                    DimensionOf dimension_of) {
  const auto names = find_joint_columns(columns, naming, set.joint_names);
  if (std::all_of(names.begin(), names.end(), [](const auto& name) { return name.empty(); })) return {};
  return read_matrix(columns, names, dimension_of);
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

/// A column "<name>_x" without another meaning must be a target of the robot.
void expect_known_targets(PoseColumns& columns, const Chain& chain) {
  for (const std::string_view name : columns.untaken_names()) {
    if (!ends_with(name, "_x") || name.substr(0, 2) == "q_") continue;
    const std::string_view target = name.substr(0, name.size() - 2);
    const auto is_it = [&](const Target& known) { return known.name == target; };
    if (std::none_of(chain.targets.begin(), chain.targets.end(), is_it))
      columns.report_header_error(fmt::format("column {}: the robot has no [[target]] named \"{}\"", name, target));
  }
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
  set.time = columns.numbers("t", Dimension::time).value_or(NumberColumn{});
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
  const ReadContext context{chain, map, required};
  for_each_list(set, [&]<class M>(const std::vector<M>&) {
    if (const auto read = measurement_columns<M>().read) read(columns, context, set);
  });
  read_covariances(columns, set);
  expect_known_targets(columns, chain);
  read_row_attributes(columns, set);
  for (std::size_t row = 0; row < columns.rows(); ++row) set.line.push_back(columns.line(row));
  return set;
}

/// A file with another delimiter looks like one with a single column.
bool has_other_delimiter(const CsvHeader& header) {
  if (header.columns.size() != 1) return false;
  return header.columns[0].find_first_of(header.delimiter == ';' ? ",\t" : ";\t") != std::string::npos;
}

}  // namespace

Result<PoseSet> parse_pose_set(std::string_view text, const std::string& name, const Chain& chain, const ColumnMap& map,
                               RequiredContent required) {
  KINFER_TRY(table, split_csv(text, name, map.format));
  return parse_pose_table(table, name, chain, map, required);
}

Result<PoseSet> parse_pose_table(const CsvTable& table, const std::string& name, const Chain& chain,
                                 const ColumnMap& map, RequiredContent required) {
  const CsvHeader& header = table.header;
  if (has_other_delimiter(header))
    return error("{}:{}: expected columns separated by \"{}\"; a column map can say delimiter = \";\"", name,
                 header.line, header.delimiter);
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
