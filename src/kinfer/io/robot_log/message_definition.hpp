// SPDX-License-Identifier: Apache-2.0
// Message types as ROS writes them (wiki.ros.org/msg, design.ros2.org): a tree of fields. Types that a file does not
// define are taken from a built-in list of common ones.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"

namespace kinfer {

enum class FieldBase { number, text, wide_text, time, message };

enum class NumberType { boolean, int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct MessageField {
  std::string name{};
  FieldBase base = FieldBase::number;
  NumberType number = NumberType::float64;
  bool is_array = false;               ///< fixed where count > 0, else of any length
  std::size_t count = 0;               ///< of a fixed array
  std::vector<MessageField> fields{};  ///< of a message
};

/// The fields of type `type` ("sensor_msgs/Imu"). `text`: its definition followed by those of the types that it
/// contains, each behind a line of = and "MSG: package/Type"; empty: the built-in one. `is_ros1`: a Header has a
/// sequence number. Errors name the type that is not defined, or the line that is not understood.
Result<std::vector<MessageField>> parse_message_definition(std::string_view text, std::string_view type, bool is_ros1);

/// Definition of a common type in ROS 2's form, those of its parts included; empty for another type.
std::string common_message_definition(std::string_view type);

}  // namespace kinfer
