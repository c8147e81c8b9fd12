// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_topics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinfer/io/robot_log/message_decoder.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer {
namespace {

/// Where a type of message has a point, and perhaps an orientation.
struct PointType {
  std::string_view type, position, orientation;
};
constexpr std::array<PointType, 4> point_types{{
    {"geometry_msgs/PoseStamped", "pose.position", "pose.orientation"},
    {"geometry_msgs/PointStamped", "point", ""},
    {"geometry_msgs/TransformStamped", "transform.translation", "transform.rotation"},
    {"geometry_msgs/PoseWithCovarianceStamped", "pose.pose.position", "pose.pose.orientation"},
}};
constexpr std::string_view joint_type = "sensor_msgs/JointState";

const PointType* point_type(std::string_view type) {
  const auto row = std::ranges::find(point_types, type, &PointType::type);
  return row == point_types.end() ? nullptr : &*row;
}

using IsWanted = bool (*)(std::string_view type);

/// The one topic that is asked for, or that is the only one of its kind; its name.
Result<std::string> choose_topic(const std::filesystem::path& path, std::span<const std::string> asked,
                                 IsWanted is_wanted, std::string_view kinds) {
  const MessageSink nothing{.wants = [](std::size_t, const LoggedTopic&) -> Result<bool> { return false; },
                            .on_message = [](const LoggedMessage&) -> Result<void> { return {}; }};
  KINFER_TRY(log, read_message_log(path, nothing));
  std::vector<std::string> fitting;
  std::string all;
  for (const LoggedTopic& topic : log.topics) {
    all += fmt::format("{}{} ({})", all.empty() ? "" : ", ", topic.name, topic.type);
    const bool is_asked = asked.empty() || std::ranges::find(asked, topic.name) != asked.end();
    if (is_asked && is_wanted(topic.type) && topic.messages > 0) fitting.push_back(topic.name);
  }
  if (fitting.empty())
    return error("{}: no topic{} of {} has messages; the topics are {}", path.string(),
                 asked.empty() ? "" : " of those that --topic names", kinds, all.empty() ? "none" : all);
  if (fitting.size() > 1) {
    std::string names;
    for (const std::string& name : fitting) names += (names.empty() ? "" : ", ") + name;
    return error("{}: {} topics could be used ({}); --topic says which", path.string(), fitting.size(), names);
  }
  return fitting.front();
}

/// Reads one topic's messages in the order of their times, repeated times left out.
class TopicReader {
 public:
  TopicReader(std::string file, std::string topic) : file_(std::move(file)), topic_(std::move(topic)) {}

  /// The first of `wanted` is the time. `add(fields)`: false where the message is of no use.
  template <class Add>
  Result<void> read(const std::filesystem::path& path, std::span<const WantedField> wanted, Add add) {
    std::optional<MessageDecoder> decoder;
    std::vector<DecodedField> fields;
    const MessageSink sink{.wants = [&](std::size_t, const LoggedTopic& topic) -> Result<bool> {
                             if (topic.name != topic_) return false;
                             type_ = topic.type;
                             KINFER_TRY(made, MessageDecoder::make(topic, wanted));
                             decoder = std::move(made);
                             return true;
                           },
                           .on_message = [&](const LoggedMessage& message) -> Result<void> {
                             ++messages_;
                             if (!decoder || !decoder->decode(message.data, fields))
                               return error("{}: a message of topic {} is shorter than its type says", file_, topic_);
                             const std::int64_t stamp = fields[0].times[0];
                             const double time = 1e-9 * static_cast<double>(stamp != 0 ? stamp : message.log_time);
                             if (!times_.empty() && !(time > times_.back())) {
                               ++late_;
                               return {};
                             }
                             if (add(fields)) {
                               times_.push_back(time);
                               lines_.push_back(static_cast<int>(messages_));
                             }
                             return {};
                           }};
    if (auto log = read_message_log(path, sink); !log) return forward_error(log.error());
    return {};
  }

  PoseTopic finish(PoseSet set) {
    PoseTopic found{.set = std::move(set), .topic = fmt::format("{} ({})", topic_, type_)};
    found.set.time = std::move(times_);
    found.set.line = std::move(lines_);
    if (late_ > 0)
      found.remarks.push_back(
          fmt::format("{}: {} of {} messages of topic {} are not later than the one before and are "
                      "not used",
                      file_, late_, messages_, topic_));
    return found;
  }

  std::size_t messages() const { return messages_; }

 private:
  std::string file_, topic_, type_;
  std::vector<double> times_;
  std::vector<int> lines_;  // number of the message, from 1
  std::size_t messages_ = 0, late_ = 0;
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// For each joint of the robot its place in the message; empty where one is missing.
std::vector<std::size_t> places_of(const std::vector<std::string>& joints, const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  for (const std::string& joint : joints) {
    const auto at = std::ranges::find(names, joint);
    if (at == names.end()) return {};
    places.push_back(static_cast<std::size_t>(at - names.begin()));
  }
  return places;
}

bool share_no_name(const std::vector<std::string>& joints, const std::vector<std::string>& names) {
  return std::ranges::none_of(joints, [&](const std::string& j) { return std::ranges::find(names, j) != names.end(); });
}

}  // namespace

Result<PoseTopic> read_joint_topic(const std::filesystem::path& path, const Chain& chain,
                                   std::span<const std::string> topics) {
  KINFER_TRY(topic, choose_topic(
                        path, topics, [](std::string_view type) { return type == joint_type; }, joint_type));
  constexpr std::array<WantedField, 3> wanted{
      {{"header.stamp", FieldBase::time}, {"name", FieldBase::text, true}, {"position", FieldBase::number, true}}};
  const std::vector<std::string> joints = active_joint_names(chain);
  TopicReader reader(path.string(), topic);
  std::vector<double> values;
  std::vector<std::string> seen;
  bool is_by_order = false;
  auto done = reader.read(path, wanted, [&](const std::vector<DecodedField>& fields) {
    const std::vector<std::string>& names = fields[1].texts;
    const std::vector<double>& positions = fields[2].numbers;
    if (seen.empty()) seen = names;
    std::vector<std::size_t> places = places_of(joints, names);
    if (places.empty() && names.size() == joints.size() && share_no_name(joints, names)) {
      is_by_order = true;
      for (std::size_t j = 0; j < joints.size(); ++j) places.push_back(j);
    }
    if (places.empty() || positions.size() < names.size()) return false;
    if (std::ranges::any_of(places, [&](std::size_t p) { return !std::isfinite(positions[p]); })) return false;
    for (const std::size_t place : places) values.push_back(positions[place]);
    return true;
  });
  if (!done) return forward_error(done.error());
  if (values.empty())
    return error("{}: no message of topic {} has all joints of the robot ({}); the first names {}", path.string(),
                 topic, joined(joints), seen.empty() ? "none" : joined(seen));
  PoseSet set;
  set.joint_names = joints;
  const auto rows = static_cast<Eigen::Index>(values.size() / joints.size());
  set.joints = Eigen::Map<const MatrixXd>(values.data(), static_cast<Eigen::Index>(joints.size()), rows);
  PoseTopic found = reader.finish(std::move(set));
  if (is_by_order)
    found.remarks.push_back(
        fmt::format("{}: topic {} names none of the robot's joints; {} are taken as {}, in this order", path.string(),
                    topic, joined(seen), joined(joints)));
  if (const std::size_t skipped = reader.messages() - static_cast<std::size_t>(rows); skipped > 0)
    found.remarks.push_back(
        fmt::format("{}: {} messages of topic {} lack joints of the robot, or repeat a time, and are not used",
                    path.string(), skipped, topic));
  return found;
}

Result<PoseTopic> read_point_topic(const std::filesystem::path& path, const Chain& chain,
                                   std::span<const std::string> topics) {
  KINFER_TRY(topic, choose_topic(
                        path, topics, [](std::string_view type) { return point_type(type) != nullptr; },
                        "geometry_msgs/PoseStamped, PointStamped or TransformStamped"));
  // The paths depend on the type, which the topic's declaration tells.
  std::string type;
  const MessageSink look{.wants = [&](std::size_t, const LoggedTopic& logged) -> Result<bool> {
                           if (logged.name == topic) type = logged.type;
                           return false;
                         },
                         .on_message = [](const LoggedMessage&) -> Result<void> { return {}; }};
  if (auto log = read_message_log(path, look); !log) return forward_error(log.error());
  const PointType& fields_of = *point_type(type);
  std::vector<std::string> names;  // of numbers
  for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{}.{}", fields_of.position, axis));
  if (!fields_of.orientation.empty())
    for (const char axis : {'w', 'x', 'y', 'z'}) names.push_back(fmt::format("{}.{}", fields_of.orientation, axis));
  std::vector<WantedField> wanted{{"header.stamp", FieldBase::time}};
  for (const std::string& name : names) wanted.push_back({name});
  TopicReader reader(path.string(), topic);
  PoseSet set;
  set.joint_names = active_joint_names(chain);
  auto done = reader.read(path, wanted, [&](const std::vector<DecodedField>& fields) {
    const auto number = [&](std::size_t at) { return fields[at].numbers[0]; };
    const Vec3 point(number(1), number(2), number(3));
    if (!point.allFinite()) return false;
    const int row = static_cast<int>(set.points.size());
    set.points.push_back({.row = row, .position = point, .sd = std::nullopt});
    if (fields.size() < 8) return true;
    const Quat orientation(number(4), number(5), number(6), number(7));
    const double norm = orientation.norm();
    if (std::isfinite(norm) && norm > 0.5)
      set.orientations.push_back({.row = row, .orientation = orientation.normalized()});
    return true;
  });
  if (!done) return forward_error(done.error());
  if (set.points.empty()) return error("{}: no message of topic {} holds a position", path.string(), topic);
  set.joints.resize(0, static_cast<Eigen::Index>(set.points.size()));
  return reader.finish(std::move(set));
}

std::string_view use_of_message_type(std::string_view type) {
  if (type == joint_type) return "joint positions: pair, calibrate (--joints), predict";
  return point_type(type) ? "tool points: pair, calibrate (--measured)" : std::string_view();
}

}  // namespace kinfer
