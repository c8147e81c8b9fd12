// SPDX-License-Identifier: Apache-2.0
// The topics of a log while it is read: numbered by the file's own identifiers, counted, and asked for once.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

class TopicTable {
 public:
  TopicTable(std::string file, const MessageSink& sink) : file_(std::move(file)), sink_(sink) {}

  /// `id`: of the file; several ids may name the same topic. An error where two types share a name.
  Result<void> add(std::uint64_t id, LoggedTopic topic);
  bool knows(std::uint64_t id) const { return by_id_.contains(id); }
  /// Whether any topic so far is wanted.
  bool is_wanted(std::uint64_t id) const;
  Result<void> message(std::uint64_t id, std::int64_t log_time, std::string_view data);

  /// Of the file's bytes or rows.
  void report_progress(std::size_t read, std::size_t all) const {
    if (all > 0)
      notify(sink_.observer,
             {.stage = "reading", .fraction = static_cast<double>(read) / static_cast<double>(all), .detail = file_});
  }

  void remark(std::string sentence) { log_.remarks.push_back(std::move(sentence)); }
  const std::string& file() const { return file_; }
  MessageLog take() { return std::move(log_); }

 private:
  std::string file_;
  const MessageSink& sink_;
  MessageLog log_;
  std::vector<bool> wanted_;
  std::unordered_map<std::uint64_t, std::size_t> by_id_;
};

/// "sensor_msgs/msg/Imu" → "sensor_msgs/Imu"
std::string plain_type_name(std::string_view type);

}  // namespace kinfer
