// SPDX-License-Identifier: Apache-2.0
// MCAP files with ROS 2 messages in zstd chunks, with index and statistics, as viewers want them (mcap.dev/spec).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// Fields of one message in CDR: little-endian, aligned behind the four bytes of the encapsulation.
class CdrMessage {
 public:
  CdrMessage& time(std::int64_t nanoseconds);
  CdrMessage& text(std::string_view text);
  CdrMessage& number(double value);
  CdrMessage& count(std::uint32_t value);  ///< length of the sequence that follows
  std::string_view bytes() const { return bytes_; }

 private:
  template <class T>
  void append(T value);
  std::string bytes_{'\0', '\1', '\0', '\0'};
};

class McapWriter {
 public:
  static Result<McapWriter> create(const std::filesystem::path& path);
  ~McapWriter();
  McapWriter(McapWriter&&) noexcept;

  /// `type`: "sensor_msgs/Imu", of the common types. Returns the number of the channel.
  std::uint16_t add_channel(std::string_view topic, std::string_view type);

  /// Messages should come in the order of time [ns].
  void write(std::uint16_t channel, std::int64_t time, const CdrMessage& message);

  /// Writes the index; an error where the disk is full.
  Result<void> finish();

 private:
  class State;
  explicit McapWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinfer
