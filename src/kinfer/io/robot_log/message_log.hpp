// SPDX-License-Identifier: Apache-2.0
// What the readers of robot logs deliver: topics, and a stream of serialised messages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"

namespace kinfer {

enum class Serialization {
  ros1,   ///< fields one after the other, little-endian
  cdr,    ///< aligned fields behind four bytes that say their byte order (ROS 2)
  other,  ///< not read: JSON, protobuf, …
};

struct LoggedTopic {
  std::string name{};        ///< "/boom/imu"
  std::string type{};        ///< "sensor_msgs/Imu": package and type, without ROS 2's "/msg"
  std::string definition{};  ///< of the message and of those it contains; empty: the file has none
  Serialization serialization = Serialization::cdr;
  std::size_t messages = 0;
  std::int64_t first_time = 0, last_time = 0;  ///< [ns] when the log received them
};

struct LoggedMessage {
  std::size_t topic = 0;      ///< index into MessageLog::topics
  std::int64_t log_time = 0;  ///< [ns]
  std::string_view data{};    ///< valid during the call
};

/// What a file holds, after reading it.
struct MessageLog {
  std::vector<LoggedTopic> topics{};
  std::vector<std::string> remarks{};  ///< of the reader, for the user, one sentence each
};

struct MessageSink {
  /// Asked once for each topic, before its messages: whether these are wanted. `index` into MessageLog::topics.
  std::function<Result<bool>(std::size_t index, const LoggedTopic& topic)> wants;
  /// Called for each wanted message, in the order of the file.
  std::function<Result<void>(const LoggedMessage& message)> on_message;
  /// Notified of the share of the file that was read.
  Observer observer{};
};

}  // namespace kinfer
