// SPDX-License-Identifier: Apache-2.0
// Messages and ROS 1 bags, written byte by byte: the other side of the readers of robot logs.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace kinfer::test {

template <class T>
std::string raw_bytes(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

inline std::string with_length(std::string_view text) {
  return raw_bytes(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

/// sensor_msgs/Imu as ROS 1 writes it.
inline std::string ros1_imu(std::uint32_t seconds, std::uint32_t nanoseconds, const std::string& frame,
                            const std::array<double, 3>& rate, const std::array<double, 3>& force) {
  std::string text = raw_bytes(std::uint32_t{7}) + raw_bytes(seconds) + raw_bytes(nanoseconds) + with_length(frame);
  const auto triad = [&](const std::array<double, 3>& values) {
    for (const double value : values) text += raw_bytes(value);
  };
  const auto covariance = [&](double first) {
    text += raw_bytes(first);
    for (int i = 1; i < 9; ++i) text += raw_bytes(0.0);
  };
  for (int i = 0; i < 4; ++i) text += raw_bytes(i == 3 ? 1.0 : 0.0);
  covariance(-1.0), triad(rate), covariance(0.0), triad(force), covariance(0.0);
  return text;
}

inline std::string bag_field(std::string_view name, std::string_view value) {
  return with_length(std::string(name) + "=" + std::string(value));
}

inline std::string bag_record(const std::string& header, const std::string& data) {
  return with_length(header) + with_length(data);
}

inline std::string bag_connection(std::uint32_t id, const std::string& topic, const std::string& type,
                                  const std::string& definition) {
  return bag_record(bag_field("op", "\x07") + bag_field("conn", raw_bytes(id)) + bag_field("topic", topic),
                    bag_field("topic", topic) + bag_field("type", type) + bag_field("md5sum", "*") +
                        bag_field("message_definition", definition));
}

inline std::string bag_message(std::uint32_t id, std::uint32_t seconds, std::uint32_t nanoseconds,
                               const std::string& data) {
  return bag_record(bag_field("op", "\x02") + bag_field("conn", raw_bytes(id)) +
                        bag_field("time", raw_bytes(seconds) + raw_bytes(nanoseconds)),
                    data);
}

/// Compresses by the library of the method: "none", "bz2", "lz4", "zstd".
inline std::string packed(std::string_view method, const std::string& bytes) {
  if (method == "none") return bytes;
  std::string to(2 * bytes.size() + 1024, '\0');
  if (method == "bz2") {
    auto size = static_cast<unsigned>(to.size());
    BZ2_bzBuffToBuffCompress(to.data(), &size, const_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()), 9,
                             0, 0);
    to.resize(size);
  } else if (method == "lz4") {
    to.resize(LZ4F_compressFrame(to.data(), to.size(), bytes.data(), bytes.size(), nullptr));
  } else {
    to.resize(ZSTD_compress(to.data(), to.size(), bytes.data(), bytes.size(), 1));
  }
  return to;
}

inline std::string bag_chunk(std::string_view method, const std::string& records) {
  return bag_record(bag_field("op", "\x05") + bag_field("compression", method) +
                        bag_field("size", raw_bytes(static_cast<std::uint32_t>(records.size()))),
                    packed(method, records));
}

inline std::string bag_of(const std::string& records) {
  return "#ROSBAG V2.0\n" +
         bag_record(bag_field("op", "\x03") + bag_field("index_pos", raw_bytes(std::uint64_t{0})), "") + records;
}

}  // namespace kinfer::test
