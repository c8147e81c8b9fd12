// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/inspect/inspect_robot_log.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer::cli {
namespace {

using UseOfType = std::pair<std::string_view, std::string_view>;
constexpr std::array<UseOfType, 2> uses{{
    {"sensor_msgs/Imu", "an INS: identify, orient, forecast"},
    {"sensor_msgs/MagneticField", "magnetometer of the INS of the same frame or name"},
}};

std::string_view use_of(const LoggedTopic& topic) {
  if (topic.serialization == Serialization::other) return "not read: neither ROS 1 nor CDR";
  const auto row = std::ranges::find(uses, topic.type, &UseOfType::first);
  return row == uses.end() ? "-" : row->second;
}

double rate_of(const LoggedTopic& topic) {
  const double seconds = 1e-9 * static_cast<double>(topic.last_time - topic.first_time);
  return topic.messages > 1 && seconds > 0.0 ? static_cast<double>(topic.messages - 1) / seconds : 0.0;
}

}  // namespace

bool is_robot_log(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(64, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return is_message_log(head.substr(0, static_cast<std::size_t>(stream.gcount())));
}

int print_topics(const std::string& file) {
  const MessageSink nothing{.wants = [](std::size_t, const LoggedTopic&) -> Result<bool> { return false; },
                            .on_message = [](const LoggedMessage&) -> Result<void> { return {}; }};
  const auto log = read_message_log(file, nothing);
  if (!log) return fail(log.error());
  std::size_t name_width = 5, type_width = 4;
  for (const LoggedTopic& topic : log->topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  fmt::print("{}: {} topics\n", file, log->topics.size());
  fmt::print("  {:<{}} {:<{}} {:>9} {:>9}  {}\n", "topic", name_width, "type", type_width, "messages", "Hz", "use");
  for (const LoggedTopic& topic : log->topics)
    fmt::print("  {:<{}} {:<{}} {:>9} {:>9.4g}  {}\n", topic.name, name_width, topic.type, type_width, topic.messages,
               rate_of(topic), use_of(topic));
  for (const std::string& remark : log->remarks) fmt::print("! {}\n", remark);
  return exit_done;
}

}  // namespace kinfer::cli
