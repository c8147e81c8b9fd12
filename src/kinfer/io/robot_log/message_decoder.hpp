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

/// A field that is asked for. Definitions come with the file: what it holds there is checked once, before any message.
struct WantedField {
  std::string_view path;  ///< "header.stamp", "angular_velocity.x"
  FieldBase base = FieldBase::number;
  bool is_list = false;  ///< an array, or inside of one; else it is there exactly once
};

/// What one message holds at one path: one value, or all elements of a list, one after the other.
struct DecodedField {
  std::vector<double> numbers{};
  std::vector<std::string> texts{};
  std::vector<std::int64_t> times{};  ///< [ns]
};

class MessageDecoder {
 public:
  /// An error where the type has no such field, or one of another kind.
  static Result<MessageDecoder> make(const LoggedTopic& topic, std::span<const WantedField> wanted);

  /// One entry a field; false where the message is shorter than its type says, or not little-endian.
  bool decode(std::string_view data, std::vector<DecodedField>& found) const;

 private:
  struct Node {
    FieldBase base = FieldBase::number;
    NumberType number = NumberType::float64;
    bool is_array = false;
    std::size_t count = 0;
    int wanted = -1;         // index of the wanted field that this is
    bool is_wanted = false;  // it or a field inside it is asked for
    std::vector<Node> fields{};
  };

  struct Search {
    std::span<const WantedField> wanted;
    std::vector<bool> is_found;
    int misfit = -1;  // index of one whose field is of another kind
  };

  static Node compile(const MessageField& field, const std::string& prefix, bool is_in_list, Search& search);
  void read_fields(const std::vector<Node>& nodes, ByteCursor& cursor, std::vector<DecodedField>& found) const;
  void read_one(const Node& node, ByteCursor& cursor, std::vector<DecodedField>& found) const;

  std::vector<Node> fields_;
  std::size_t wanted_ = 0;
  bool is_aligned_ = true;  // CDR
};

}  // namespace kinfer
