// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "kinfer/io/robot_log/topic_table.hpp"
#include "kinfer/io/text/trim.hpp"

namespace kinfer {
namespace {

constexpr int deepest_nesting = 16;        // a type that contains itself is refused here
constexpr std::size_t most_fields = 4096;  // of one message, those of its parts included

using NamedNumber = std::pair<std::string_view, NumberType>;
constexpr std::array<NamedNumber, 13> number_types{{{"bool", NumberType::boolean},
                                                    {"byte", NumberType::uint8},
                                                    {"char", NumberType::uint8},
                                                    {"int8", NumberType::int8},
                                                    {"uint8", NumberType::uint8},
                                                    {"int16", NumberType::int16},
                                                    {"uint16", NumberType::uint16},
                                                    {"int32", NumberType::int32},
                                                    {"uint32", NumberType::uint32},
                                                    {"int64", NumberType::int64},
                                                    {"uint64", NumberType::uint64},
                                                    {"float32", NumberType::float32},
                                                    {"float64", NumberType::float64}}};

using TextByType = std::pair<std::string_view, std::string_view>;
/// Fields of the common types (ROS 2's; see ros1_header).
constexpr std::array<TextByType, 18> built_in_types{{
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
    {"geometry_msgs/PoseWithCovarianceStamped", "std_msgs/Header header\nPoseWithCovariance pose"},
    {"std_msgs/String", "string data"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point"},
    {"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector"},
    {"geometry_msgs/TransformStamped", "std_msgs/Header header\nstring child_frame_id\nTransform transform"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance"},
    {"sensor_msgs/MagneticField",
     "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"},
}};
constexpr std::string_view ros1_header = "uint32 seq\ntime stamp\nstring frame_id";

std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trim(line.substr(0, line.find('#')));
}

/// "int32 ERROR=1": an equals sign that is neither of a bound (string<=10) nor inside a default value.
bool is_constant(std::string_view line) {
  for (std::size_t i = 0; i < line.size() && line[i] != '"' && line[i] != '\''; ++i)
    if (line[i] == '=' && (i == 0 || line[i - 1] != '<')) return true;
  return false;
}

/// A type without package is Header, or of the package of the type that names it.
std::string full_type_name(std::string_view type, std::string_view within) {
  if (type == "Header") return "std_msgs/Header";
  if (type.find('/') != std::string_view::npos) return plain_type_name(type);
  return std::string(within.substr(0, within.find('/') + 1)) + std::string(type);
}

class DefinitionParser {
 public:
  DefinitionParser(std::string_view text, std::string_view root, bool is_ros1) : is_ros1_(is_ros1) {
    // The sections: that of the root type first, then each type it contains.
    std::string type(root);
    std::string_view left = text;
    const char* begin = text.data();
    while (!left.empty()) {
      const char* here = left.data();
      const std::string_view line = next_line(left);
      const bool is_rule = line.starts_with("===");
      if (!is_rule && !line.starts_with("MSG:")) continue;
      store(type, {begin, static_cast<std::size_t>(here - begin)});
      if (!is_rule) type = plain_type_name(trim(line.substr(4)));
      begin = left.data();
    }
    store(type, {begin, static_cast<std::size_t>(text.data() + text.size() - begin)});
  }

  Result<std::vector<MessageField>> parse(const std::string& type, int depth) {
    const auto text = text_of(type);
    if (!text) return error("the log does not define message type {}", type);
    if (depth > deepest_nesting) return error("message type {} contains itself", type);
    std::vector<MessageField> fields;
    std::string_view left = *text;
    while (!left.empty()) {
      const std::string_view line = next_line(left);
      if (line.empty() || is_constant(line)) continue;
      KINFER_TRY(field, parse_field(line, type, depth));
      fields.push_back(std::move(field));
      if (++fields_ > most_fields) return error("message type {} has more than {} fields", type, most_fields);
    }
    return fields;
  }

 private:
  void store(const std::string& type, std::string_view text) {
    if (!trim(text).empty()) sections_.emplace(type, text);
  }

  std::optional<std::string_view> text_of(const std::string& type) const {
    if (const auto found = sections_.find(type); found != sections_.end()) return found->second;
    if (is_ros1_ && type == "std_msgs/Header") return ros1_header;
    const auto row = std::ranges::find(built_in_types, type, &TextByType::first);
    return row == built_in_types.end() ? std::nullopt : std::optional(row->second);
  }

  Result<MessageField> parse_field(std::string_view line, const std::string& within, int depth) {
    const std::size_t space = line.find_first_of(" \t");
    if (space == std::string_view::npos) return error("message type {}: \"{}\" is no field", within, line);
    std::string_view type = line.substr(0, space), rest = trim(line.substr(space));
    MessageField field;
    field.name = rest.substr(0, rest.find_first_of(" \t"));  // behind it: a default value
    if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
      const std::string_view inside = type.substr(bracket + 1, type.size() - bracket - 2);
      const auto [end, failure] = std::from_chars(inside.data(), inside.data() + inside.size(), field.count);
      const bool is_number = failure == std::errc() && end == inside.data() + inside.size();
      if (!type.ends_with(']') || (!inside.empty() && !inside.starts_with("<=") && !is_number))
        return error("message type {}: \"{}\" is no field", within, line);
      if (!is_number) field.count = 0;
      field.is_array = true;
      type = type.substr(0, bracket);
    }
    type = type.substr(0, type.find("<="));
    if (auto done = set_base(type, within, depth, field); !done) return forward_error(done.error());
    return field;
  }

  Result<void> set_base(std::string_view type, const std::string& within, int depth, MessageField& field) {
    const auto number = std::ranges::find(number_types, type, &NamedNumber::first);
    if (number != number_types.end()) {
      field.number = number->second;
    } else if (type == "string" || type == "wstring") {
      field.base = type == "string" ? FieldBase::text : FieldBase::wide_text;
    } else if (type == "time" || type == "duration") {
      field.base = FieldBase::time;
    } else {
      const std::string name = full_type_name(type, within);
      field.base = FieldBase::message;
      if (name == "builtin_interfaces/Time" || name == "builtin_interfaces/Duration") {
        field.base = FieldBase::time;
        return {};
      }
      KINFER_TRY(fields, parse(name, depth + 1));
      field.fields = std::move(fields);
    }
    return {};
  }

  std::map<std::string, std::string_view> sections_;
  bool is_ros1_;
  std::size_t fields_ = 0;
};

std::string_view built_in_text(std::string_view type) {
  const auto row = std::ranges::find(built_in_types, type, &TextByType::first);
  return row == built_in_types.end() ? std::string_view() : row->second;
}

}  // namespace

std::string common_message_definition(std::string_view type) {
  std::string text(built_in_text(type));
  std::vector<std::string> written{std::string(type)};
  for (std::size_t i = 0; i < written.size(); ++i)
    for (std::string_view left = built_in_text(written[i]); !left.empty();) {
      const std::string_view line = next_line(left);
      const std::string_view field = line.substr(0, line.find_first_of(" ["));
      const std::string name = full_type_name(field, written[i]);
      if (built_in_text(name).empty() || std::ranges::find(written, name) != written.end()) continue;
      written.push_back(name);
      text += fmt::format("\n{}\nMSG: {}\n{}", std::string(80, '='), name, built_in_text(name));
    }
  return text + "\n";
}

Result<std::vector<MessageField>> parse_message_definition(std::string_view text, std::string_view type, bool is_ros1) {
  return DefinitionParser(text, type, is_ros1).parse(std::string(type), 0);
}

}  // namespace kinfer
