// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/inspect/inspect_robot_log.hpp"

#include <algorithm>

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/io/pose_set/pose_topics.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer::cli {
namespace {

std::string_view use_of(const LoggedTopic& topic) {
  if (topic.serialization == Serialization::other) return "not read: neither ROS 1 nor CDR";
  if (topic.type == "sensor_msgs/Imu") return "an INS: identify, orient, forecast, track";
  if (topic.type == "sensor_msgs/MagneticField") return "magnetometer of the INS of the same frame or name";
  const std::string_view use = use_of_message_type(topic.type);
  return use.empty() ? "-" : use;
}

double rate_of(const LoggedTopic& topic) {
  const double seconds = 1e-9 * static_cast<double>(topic.last_time - topic.first_time);
  return topic.messages > 1 && seconds > 0.0 ? static_cast<double>(topic.messages - 1) / seconds : 0.0;
}

}  // namespace

bool is_robot_log(const std::string& file) {
  return is_message_log_file(file);
}

Result<MessageLog> read_topics(const std::string& file) {
  const MessageSink nothing{.wants = [](std::size_t, const LoggedTopic&) -> Result<bool> { return false; },
                            .on_message = [](const LoggedMessage&) -> Result<void> { return {}; }};
  return read_message_log(file, nothing);
}

bool has_imu(const MessageLog& log) {
  return std::ranges::any_of(log.topics,
                             [](const LoggedTopic& t) { return t.type == "sensor_msgs/Imu" && t.messages > 0; });
}

nlohmann::ordered_json topics_json(const MessageLog& log) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const LoggedTopic& topic : log.topics)
    out.push_back({{"topic", topic.name},
                   {"type", topic.type},
                   {"messages", topic.messages},
                   {"rate_hz", rate_of(topic)},
                   {"use", use_of(topic)}});
  return out;
}

void print_topics(const std::string& file, const MessageLog& log) {
  std::size_t name_width = 5, type_width = 4;
  for (const LoggedTopic& topic : log.topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  print_text("{}: {} topics\n", file, log.topics.size());
  print_text("  {:<{}} {:<{}} {:>9} {:>9}  {}\n", "topic", name_width, "type", type_width, "messages", "Hz", "use");
  for (const LoggedTopic& topic : log.topics)
    print_text("  {:<{}} {:<{}} {:>9} {:>9.4g}  {}\n", topic.name, name_width, topic.type, type_width, topic.messages,
               rate_of(topic), use_of(topic));
  for (const std::string& remark : log.remarks) print_text("! {}\n", remark);
}

}  // namespace kinfer::cli
