// SPDX-License-Identifier: Apache-2.0
// Numbers and texts of chosen fields out of serialised messages; the other fields are only stepped over.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/robot_log/byte_cursor.hpp"
#include "kinfer/io/robot_log/message_definition.hpp"
#include "kinfer/io/robot_log/message_log.hpp"

namespace kinfer {

/// What one message holds at one path: all elements of an array, one after the other.
struct DecodedField {
  std::vector<double> numbers{};
  std::vector<std::string> texts{};
  std::vector<std::int64_t> times{};  ///< [ns]
};

class MessageDecoder {
 public:
  /// `paths`: "header.stamp", "angular_velocity.x". An error where the type has no such field.
  static Result<MessageDecoder> make(const LoggedTopic& topic, std::span<const std::string_view> paths);

  /// One entry a path; false where the message is shorter than its type says, or not little-endian.
  bool decode(std::string_view data, std::vector<DecodedField>& found) const;

 private:
  struct Node {
    FieldBase base = FieldBase::number;
    NumberType number = NumberType::float64;
    bool is_array = false;
    std::size_t count = 0;
    int path = -1;           // index of the path that this field is
    bool is_wanted = false;  // it or a field inside it is asked for
    std::vector<Node> fields{};
  };

  static Node compile(const MessageField& field, const std::string& prefix, std::span<const std::string_view> paths,
                      std::vector<bool>& is_found);
  void read_fields(const std::vector<Node>& nodes, ByteCursor& cursor, std::vector<DecodedField>& found) const;
  void read_one(const Node& node, ByteCursor& cursor, std::vector<DecodedField>& found) const;

  std::vector<Node> fields_;
  std::size_t paths_ = 0;
  bool is_aligned_ = true;  // CDR
};

}  // namespace kinfer
