// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/possible_values.hpp"
#include "kinfer/io/text/toml_reader.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// The enumerator of that name.
template <class Kind, std::size_t count>
Kind read_kind(TableReader& reader, std::string_view key) {
  const std::string text = reader.text(key);
  for (std::size_t i = 0; i < count; ++i)
    if (name(static_cast<Kind>(i)) == text) return static_cast<Kind>(i);
  reader.report_error(reader.line_of(key), fmt::format("\"{}\": \"{}\" is none of its values", key, text));
  return Kind{};
}

constexpr PossibleRange clock_time{"a time of a sensor", 1e4, "s"};

Mat3 matrix(TableReader& reader, std::string_view key) {
  const std::vector<double> numbers = possible_numbers(reader, key, 9);
  Mat3 m = Mat3::Zero();
  if (numbers.size() == 9) m = Eigen::Map<const Mat3>(numbers.data()).transpose();
  return m;
}

Mat3 rotation(TableReader& reader, std::string_view key) {
  constexpr double tolerance = 1e-6;
  Mat3 r = matrix(reader, key);
  if (!((r * r.transpose() - Mat3::Identity()).norm() < tolerance && r.determinant() > 0.0))
    reader.report_error(reader.line_of(key), fmt::format("\"{}\" is no rotation", key));
  return r;
}

/// Of an angular velocity and a force: standard deviations.
InsLevel pair(TableReader& reader, std::string_view key) {
  const std::vector<double> numbers = possible_numbers(reader, key, 2);
  for (const double value : numbers)
    if (value < 0.0)
      reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected numbers that are not negative", key));
  return numbers.size() == 2 ? InsLevel{numbers[0], numbers[1]} : InsLevel{};
}

/// An index from `lowest` to below `end`.
int index(TableReader& reader, std::string_view key, int lowest, std::size_t end) {
  const double value = reader.number(key);
  if (value == std::floor(value) && value >= lowest && value < static_cast<double>(end)) return static_cast<int>(value);
  reader.report_error(reader.line_of(key), fmt::format("\"{}\": {} is out of range", key, value));
  return lowest;
}

/// Reads one table of the file by `read`.
template <class Read>
void in_table(TableReader& file, const char* key, FirstError& first_error, const Read& read) {
  const TomlTable* table = file.table_or_none(key);
  if (!table) return file.report_error(file.line(), fmt::format("[{}] is missing", key));
  TableReader reader(*table, file.line_of(key), fmt::format("{}: ", key), first_error);
  read(reader);
  reader.expect_no_other_keys();
}

/// Reads every [[key]].
template <class Read>
void in_tables(TableReader& file, const char* key, FirstError& first_error, const Read& read) {
  int number = 0;
  for (const auto& [table, line] : file.tables_or_none(key)) {
    TableReader reader(*table, line, fmt::format("{} {}: ", key, ++number), first_error);
    read(reader);
    reader.expect_no_other_keys();
  }
}

TrackingSensor read_sensor(TableReader& t, std::size_t bodies) {
  TrackingSensor s;
  s.name = t.text("name");
  s.body = index(t, "body", 0, bodies);
  s.gyroscope_bias = vector_within(t, "gyroscope_bias", possible_range(Dimension::angular_rate));
  s.accelerometer_bias = vector_within(t, "accelerometer_bias", possible_range(Dimension::acceleration));
  s.gyroscope_scale = matrix(t, "gyroscope_scale");
  s.accelerometer_scale = matrix(t, "accelerometer_scale");
  s.noise = pair(t, "noise");
  s.residual = pair(t, "residual");
  s.slow_residual = pair(t, "slow_residual");
  s.sample_period = magnitude(t, "sample_period", clock_time);
  s.mount_compliance = matrix(t, "mount_compliance");
  s.mount_stray = magnitude(t, "mount_stray", possible::number);
  s.clock_offset = within(t, "clock_offset", clock_time);
  s.clock_offset_sd = magnitude(t, "clock_offset_sd", clock_time);
  return s;
}

TrackingBody read_body(TableReader& t, const TrackingModel& model, std::size_t sensors, std::size_t joints) {
  TrackingBody b;
  const std::size_t number = model.bodies.size();
  b.parent = number == 0 ? index(t, "parent", -1, 0) : index(t, "parent", 0, number);
  b.sensor = index(t, "sensor", -1, sensors);
  b.joint = number == 0 ? index(t, "joint", -1, 0) : index(t, "joint", 0, joints);
  b.motion = read_kind<TrackingMotion, 4>(t, "motion");
  b.parent_R_axis = rotation(t, "parent_R_axis");
  b.child_R_axis = rotation(t, "child_R_axis");
  b.point_in_parent = vector_within(t, "point_in_parent", possible::length);
  b.point_in_child = vector_within(t, "point_in_child", possible::length);
  return b;
}

TrackingJoint read_joint(TableReader& t, FirstError& first_error) {
  TrackingJoint j;
  j.name = t.text("name");
  j.type = read_kind<EstimatedJointType, 5>(t, "type");
  j.stray = magnitude(t, "stray", possible::number);
  j.stray_time = magnitude(t, "stray_time", possible_range(Dimension::time));
  in_tables(t, "range", first_error, [&](TableReader& r) {
    j.range.push_back({within(r, "lower", possible::length), within(r, "upper", possible::length),
                       magnitude(r, "speed", possible::number), magnitude(r, "acceleration", possible::number)});
  });
  return j;
}

/// Positions of each joint from the bodies that it consists of.
void count_positions(TrackingModel& model) {
  int next = 0;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    TrackingJoint& joint = model.joints[j];
    joint.first_position = next;
    joint.positions = 0;
    for (const TrackingBody& body : model.bodies)
      if (body.joint == static_cast<int>(j)) joint.positions += degrees_of_freedom(body.motion);
    next += joint.positions;
  }
}

std::optional<TrackingParameter> parameter_of(std::string_view text, const TrackingModel& model) {
  for (int k = 0; k < 8; ++k) {
    const auto kind = static_cast<TrackingParameterKind>(k);
    const std::string prefix = std::string(name(kind)) + " ";
    int where = -1, component = -1;
    if (text.substr(0, prefix.size()) != prefix ||
        std::sscanf(std::string(text.substr(prefix.size())).c_str(), "%d %d", &where, &component) != 2)
      continue;
    const bool is_body = kind <= TrackingParameterKind::point_in_child;
    const std::size_t end = is_body ? model.bodies.size() : model.sensors.size();
    const int components = kind >= TrackingParameterKind::gyroscope_scale ? 9 : 3;
    if (where >= 0 && static_cast<std::size_t>(where) < end && component >= 0 && component < components)
      return TrackingParameter{kind, where, component};
  }
  return std::nullopt;
}

/// Of the standard deviation of a parameter.
PossibleRange possible_sd(TrackingParameterKind kind) {
  const double most = largest_deviation(kind);
  switch (kind) {
    case TrackingParameterKind::parent_rotation:
    case TrackingParameterKind::child_rotation:
      return {"the standard deviation of a direction", most, "rad"};
    case TrackingParameterKind::point_in_parent:
    case TrackingParameterKind::point_in_child:
      return {"the standard deviation of a point", most, "m"};
    case TrackingParameterKind::gyroscope_bias:
      return {"the standard deviation of a bias", most, "rad/s"};
    case TrackingParameterKind::accelerometer_bias:
      return {"the standard deviation of a bias", most, "m/s^2"};
    case TrackingParameterKind::gyroscope_scale:
    case TrackingParameterKind::accelerometer_scale:
      break;
  }
  return {"the standard deviation of a scale", most, "1"};
}

void read_covariance(TableReader& t, const TomlTable& file, TrackingModel& model) {
  t.ignore("parameters");
  const auto* table = std::get_if<TomlTable>(&file.find("covariance")->value);
  const TomlValue* names = table ? table->find("parameters") : nullptr;
  const auto* list = names ? std::get_if<TomlArray>(&names->value) : nullptr;
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const auto* text = std::get_if<std::string>(&(*list)[i].value);
    const auto parameter = text ? parameter_of(*text, model) : std::nullopt;
    if (parameter)
      model.parameters.push_back(*parameter);
    else
      t.report_error((*list)[i].line, "\"parameters\": expected texts such as \"point_in_child 1 0\"");
  }
  if (!list) t.report_error(t.line(), "\"parameters\" is missing");
  const auto size = static_cast<Index>(model.parameters.size());
  const std::vector<double> numbers = possible_numbers(t, "root", static_cast<std::size_t>(size * (size + 1) / 2));
  MatrixXd root = MatrixXd::Zero(size, size);
  std::size_t next = 0;
  for (Index i = 0; i < size; ++i)
    for (Index j = 0; j <= i && next < numbers.size(); ++j) root(i, j) = numbers[next++];
  for (Index i = 0; i < size; ++i)
    t.expect_possible("root", root.row(i).norm(), possible_sd(model.parameters[static_cast<std::size_t>(i)].kind));
  model.covariance = times_transposed(root, root);
}

void read_head(TableReader& file, TrackingModel& model, FirstError& first_error) {
  model.gravity = magnitude(file, "gravity", possible::gravity);
  model.gravity_sd = magnitude(file, "gravity_sd", possible::gravity);
  in_table(file, "prior", first_error, [&](TableReader& t) {
    model.prior = {.rotation = magnitude(t, "rotation", possible::number),
                   .point = magnitude(t, "point", possible::number),
                   .bias = pair(t, "bias"),
                   .scale = pair(t, "scale"),
                   .bias_instability = pair(t, "bias_instability"),
                   .instability_time = magnitude(t, "instability_time", possible_range(Dimension::time))};
  });
  in_table(file, "base", first_error, [&](TableReader& t) {
    model.base = {t.flag_or("moved", false), vector_within(t, "force", possible_range(Dimension::acceleration)),
                  magnitude(t, "angular_acceleration", possible::number),
                  magnitude(t, "acceleration", possible::number)};
  });
  in_table(file, "tool", first_error, [&](TableReader& t) {
    model.tool.body = index(t, "body", 0, model.bodies.size());
    model.tool.body_T_tool = {rotation(t, "rotation"), vector_within(t, "xyz", possible::length)};
    model.tool.sd = vector_within(t, "sd", possible::number);
  });
}

}  // namespace

Result<TrackingModel> parse_tracking_model(std::string_view text, const std::string& name_in_messages) {
  KINFER_TRY(table, parse_toml(text, name_in_messages));
  FirstError first_error(name_in_messages);
  TableReader file(table, 1, "", first_error);
  TrackingModel model;
  const std::size_t sensors = file.tables_or_none("sensor").size(), joints = file.tables_or_none("joint").size();
  in_tables(file, "body", first_error,
            [&](TableReader& t) { model.bodies.push_back(read_body(t, model, sensors, joints)); });
  in_tables(file, "sensor", first_error,
            [&](TableReader& t) { model.sensors.push_back(read_sensor(t, model.bodies.size())); });
  in_tables(file, "joint", first_error, [&](TableReader& t) { model.joints.push_back(read_joint(t, first_error)); });
  if (sensors == 0 || model.bodies.empty()) file.report_error(1, "no [[sensor]] or no [[body]]");
  read_head(file, model, first_error);
  count_positions(model);
  in_table(file, "covariance", first_error, [&](TableReader& t) { read_covariance(t, table, model); });
  file.expect_no_other_keys();
  if (first_error.any()) return tl::unexpected(first_error.as_error());
  expect_well_formed(model);
  return model;
}

Result<TrackingModel> read_tracking_model(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_tracking_model(text, path.string());
}

}  // namespace kinfer
